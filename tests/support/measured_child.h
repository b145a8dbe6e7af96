/// Children whose time and memory are measured one by one.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace meniscus {

struct MeasuredChild {
  bool succeeded = false;     // exited with code 0
  double user_seconds = 0.0;  // CPU time in user mode, all threads
  double system_seconds = 0.0;
  double wall_seconds = 0.0;
  double peak_bytes = 0.0;  // largest resident set
  std::string output;       // what `work` returned, or the program's stdout
};

/// Runs `work` in a forked child and hands back the text it returns. An
/// exception in it ends the child without success, its message as output. The
/// peak counts what this process held at the fork: call it from a small one.
MeasuredChild measure_forked(const std::function<std::string()>& work);

/// Runs a program (looked up in PATH) with empty stdin, in `folder`; ended
/// after `time_limit` seconds of CPU time.
MeasuredChild measure_program(const std::vector<std::string>& argv,
                              const std::filesystem::path& folder,
                              double time_limit);

}  // namespace meniscus
