/// The program's exit codes, a contract with scripts that call it, and the one
/// place where exceptions become one of them and a message.
#pragma once

#include <exception>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "pipeline/study/study.h"

namespace meniscus::app {

inline constexpr int kExitDone = 0;
inline constexpr int kExitWrongInput = 2;  // found before work starts
inline constexpr int kExitNoSolution = 3;  // infeasible, stopped, failed
inline constexpr int kExitError = 4;       // internal error, full disk
inline constexpr int kExitInterrupted = 130;

/// Of result.json's status.
int exit_code_of(study::RunStatus status);

/// What an exception of one type means where the rule holds.
struct ErrorRule {
  bool (*matches)(const std::exception&) = nullptr;
  int exit_code = kExitError;
  std::string prefix = {};  // before the exception's message
};

/// on<IoError>(kExitWrongInput): derived types too.
template <class Exception>
ErrorRule on(int exit_code, std::string prefix = {}) {
  return {[](const std::exception& error) {
            if constexpr (std::is_same_v<Exception, std::exception>) {
              return true;
            } else {
              return dynamic_cast<const Exception*>(&error) != nullptr;
            }
          },
          exit_code, std::move(prefix)};
}

/// What holds for all commands where they have no rule of their own: wrong
/// input is 2, a stop 130, a file that the machine refuses, want of memory and
/// everything else 4.
std::vector<ErrorRule> program_rules();

/// What work() returns; or, when it throws, the exit code of the first rule
/// that matches, its message on stderr. What no rule is for passes through.
int exit_code_of(const std::vector<ErrorRule>& rules,
                 const std::function<int()>& work);

}  // namespace meniscus::app
