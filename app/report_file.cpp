#include "app/report_file.h"

#include <cstdio>

#include "core/error.h"
#include "report/page/report_page.h"

namespace meniscus {

void report_aloud(const std::filesystem::path& folder,
                  const RunArguments& arguments, Monitor& monitor) {
  if (!arguments.report) {
    return;
  }
  try {
    monitor.progress({.stage = "output", .detail = "writing the report page"});
    for (const std::string& warning :
         write_report(folder, {.versions = version_text()})) {
      std::fprintf(stderr, "warning: %s\n", warning.c_str());
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "warning: no report page: %s\n", error.what());
  }
}

}  // namespace meniscus
