#include "app/case_input.h"

#include <cstdio>

#include "app/signals.h"

namespace meniscus {

CaseReading read_case_aloud(const std::string& path,
                            const CommonArguments& common) {
  CaseReading reading = read_case_file(path, common.overrides);
  for (const std::string& problem : reading.problems) {
    std::fprintf(stderr, "%s\n", problem.c_str());
  }
  if (!common.quiet) {
    for (const std::string& warning : reading.warnings) {
      std::fprintf(stderr, "%s\n", warning.c_str());
    }
  }
  return reading;
}

std::filesystem::path results_folder(const Case& input,
                                     const std::string& out) {
  return out.empty() ? std::filesystem::path("results") / input.name
                     : std::filesystem::path(out);
}

TerminalMonitorOptions monitor_options(const CommonArguments& common) {
  return {.style = common.quiet ? MonitorStyle::Quiet : MonitorStyle::Automatic,
          .log_file = common.log,
          .stop = [] { return stop_signal() != 0; }};
}

}  // namespace meniscus
