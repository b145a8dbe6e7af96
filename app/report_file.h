/// report.html at the end of a run.
#pragma once

#include <filesystem>

#include "app/commands.h"
#include "core/monitor.h"

namespace meniscus {

/// Writes FOLDER/report.html where `arguments` want it. What hinders it is a
/// warning on stderr: a run without its page is still a run.
void report_aloud(const std::filesystem::path& folder,
                  const RunArguments& arguments, Monitor& monitor);

}  // namespace meniscus
