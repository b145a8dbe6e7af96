/// A whole study into a folder, as the program's run leaves it.
#pragma once

#include <string>
#include <vector>

#include "core/monitor.h"
#include "pipeline/case_data/case.h"

namespace meniscus::python {

struct StudyRunOptions {
  std::string folder;
  bool resume = false;
  int jobs = 1;
  double time_limit = 0.0;  // [s], 0: none
  bool estimate_errors = true;
  bool pictures = true;               // where the helper program is found
  bool frames = true;                 // films of the design's history
  bool report = true;                 // report.html
  int threads = 1;                    // of all jobs together
  std::vector<std::string> warnings;  // of the case, for result.json
};

/// Also a family. Throws what the engine throws; Interrupted and IoError once
/// the folder's result.json tells of them.
void run_into_folder(const Case& input, const StudyRunOptions& options,
                     Monitor& monitor);

}  // namespace meniscus::python
