#include <cstdio>

#include <fmt/format.h>

#include "app/case_input.h"
#include "app/commands.h"
#include "app/exit_code.h"
#include "app/signals.h"
#include "core/error.h"
#include "core/nearest_name.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/forward/gradient_check.h"

namespace meniscus::app {

namespace {

/// The initial design with "name=value" put in.
VectorX design_at(const case_data::Case& input,
                  const std::vector<std::string>& places) {
  VectorX design = case_data::initial_design(input);
  for (const std::string& text : places) {
    const auto [name, value] = named_number("--at", text);
    const std::vector<std::size_t> found = case_data::positions_of(input, name);
    if (found.empty()) {
      const std::string near = nearest_name(name, case_data::row_names(input));
      throw InvalidInput(fmt::format(
          "--at {}: expected NAME=VALUE of a design variable{}", text,
          near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
    for (const std::size_t k : found) {
      const case_data::DesignVariable& variable = input.design[k];
      if (!(value >= variable.lower && value <= variable.upper)) {
        throw InvalidInput(
            fmt::format("--at {}: outside the bounds {:g} to {:g}", text,
                        variable.lower, variable.upper));
      }
      design[static_cast<Eigen::Index>(k)] = value;
    }
  }
  return design;
}

}  // namespace

int check_gradient_command(const CheckGradientArguments& arguments) {
  const reader::CaseReading reading =
      read_and_report_case(arguments.case_path, arguments.common);
  if (!reading.input) {
    return kExitWrongInput;
  }
  const case_data::Case& input = *reading.input;
  TerminalMonitor monitor(monitor_options(arguments.common));
  catch_stop_signals();
  return exit_code_of({on<SolverError>(kExitNoSolution, "failed: ")}, [&] {
    const forward::CaseGradientCheck check = forward::check_case_gradient(
        input, design_at(input, arguments.at), {.monitor = &monitor},
        arguments.directions);
    if (!arguments.common.quiet || !check.report.passed) {
      std::fputs(forward::gradient_check_text(input, check).c_str(), stdout);
    }
    return check.report.passed ? kExitDone : kExitError;
  });
}

}  // namespace meniscus::app
