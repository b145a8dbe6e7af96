/// report.html: one file that shows a run, a family, a comparison or a film in
/// any browser, without a network. It is made of what stands in the folder
/// alone (docs/report.md), so that it can be made again at any time.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/monitor.h"

namespace meniscus::page {

/// Bytes that a page may have.
inline constexpr double kMostPageBytes = 8e6;

struct ReportOptions {
  std::string versions;  // of the program and its libraries, for people
};

/// Writes FOLDER/report.html from FOLDER/result.json (a run or a family),
/// FOLDER/compare.json or FOLDER/film.json (the first that is there), and from
/// the meshes, the study and the list of frames beside it as far as they are
/// there. Meshes are thinned out until the page is below kMostPageBytes, and
/// the page says so. Returns a warning instead where this program holds no
/// page. Throws InvalidInput, naming the file, when the folder holds no results
/// or damaged ones; IoError when the page cannot be written. Nothing is left
/// half-written then.
std::vector<std::string> write_report(const std::filesystem::path& folder,
                                      const ReportOptions& options = {});

/// The same at the end of a run, which is a run without its page too: what
/// hinders it goes to `warn` (may be empty) like its warnings. `monitor` may be
/// null.
void write_report_or_warn(const std::filesystem::path& folder,
                          const ReportOptions& options, Monitor* monitor,
                          const std::function<void(const std::string&)>& warn);

}  // namespace meniscus::page
