/// Internal: OpenCASCADE in a process of its own, the helper `meniscus-step`.
/// On a damaged file it may end its process, run without end or take all
/// memory; here that is an error of the file. Limits of reading grow with the
/// file: 10 s for each question and 0.9 GB, and 20 s and 0.5 GB more for each
/// MB of it. Writing has none: the solid is the program's own.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/child_process.h"
#include "core/frame.h"

namespace meniscus::step {

enum class StepTask { Read, Write };

class StepChild {
 public:
  /// Starts the helper for one file. Throws IoError when the helper or a file
  /// to read is not there.
  StepChild(const std::filesystem::path& path, StepTask task,
            Monitor* monitor = nullptr);

  /// The answer to a question, behind its StepAnswer. Throws what the answer
  /// says, InvalidInput (of writing: MeshError) where the helper did not come
  /// to an answer, Interrupted when the monitor asks to stop.
  std::string ask(const FrameWriter& question);

 private:
  std::filesystem::path path_;
  StepTask task_;
  ChildOptions options_;
  std::unique_ptr<AskedChild> child_;
};

}  // namespace meniscus::step
