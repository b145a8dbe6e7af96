#include <cstdio>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/exit_code.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "pipeline/results/scan_curves.h"

namespace meniscus::app {

int curves_command(const CurvesArguments& arguments) {
  std::string text;
  // Until then nothing is written: whatever is wrong is wrong with the scan.
  const int no_curves = exit_code_of({on<Error>(kExitWrongInput)}, [&] {
    const scan::ScanRimReport report =
        results::rims_of_scan(arguments.scan, {.angle = arguments.angle,
                                               .radius = arguments.radius,
                                               .points = arguments.points});
    if (report.rims.empty()) {
      std::fprintf(stderr,
                   "%s: no closed line turns by %g degrees within %.3g; try a "
                   "smaller --angle, or another --radius\n",
                   arguments.scan.c_str(), arguments.angle,
                   2.0 * report.radius);
      return kExitNoSolution;
    }
    text = results::curves_text(report, arguments.scan);
    return kExitDone;
  });
  if (no_curves != kExitDone) {
    return no_curves;
  }
  if (arguments.out.empty()) {
    std::fputs(text.c_str(), stdout);
    return kExitDone;
  }
  write_file(arguments.out, text);
  std::printf("%s\n", arguments.out.c_str());
  return kExitDone;
}

}  // namespace meniscus::app
