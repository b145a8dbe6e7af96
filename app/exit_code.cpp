#include "app/exit_code.h"

#include <cstdio>
#include <new>

#include "core/error.h"
#include "core/math/expression.h"

namespace meniscus::app {

namespace {

/// In place of std::bad_alloc's own words.
const char* message_of(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr
             ? "not enough memory; try longer edges"
             : error.what();
}

}  // namespace

int exit_code_of(study::RunStatus status) {
  switch (status) {
    case study::RunStatus::Converged:
      return kExitDone;
    case study::RunStatus::Infeasible:
    case study::RunStatus::Stopped:
    case study::RunStatus::Failed:
      return kExitNoSolution;
    case study::RunStatus::Error:
      return kExitError;
    case study::RunStatus::Interrupted:
      return kExitInterrupted;
  }
  return kExitError;
}

std::vector<ErrorRule> program_rules() {
  return {on<InvalidInput>(kExitWrongInput),
          on<ExpressionError>(kExitWrongInput),
          on<Interrupted>(kExitInterrupted),
          on<std::exception>(kExitError, "error: ")};
}

int exit_code_of(const std::vector<ErrorRule>& rules,
                 const std::function<int()>& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    for (const ErrorRule& rule : rules) {
      if (rule.matches(error)) {
        std::fprintf(stderr, "%s%s\n", rule.prefix.c_str(), message_of(error));
        return rule.exit_code;
      }
    }
    throw;
  }
}

}  // namespace meniscus::app
