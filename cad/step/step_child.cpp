#include "cad/step/step_child.h"

#include <new>

#include <fmt/format.h>

#include "cad/step/step_messages.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/find_program.h"

namespace meniscus::step {

namespace {

constexpr double kLeastTime = 10.0;  // [s]
constexpr double kTimePerByte = 20e-6;
constexpr double kLeastMemory = 0.9e9;  // [byte] of address space
constexpr double kMemoryPerByte = 500.0;

[[noreturn]] void refuse_reading(const std::filesystem::path& path,
                                 const ChildOptions& options,
                                 const ChildResult& end) {
  constexpr const char* kAdvice =
      "the file is damaged or too large; write it anew from its CAD program";
  throw InvalidInput(
      end.timed_out
          ? fmt::format(
                "{}: OpenCASCADE did not come to an end with it in {:.0f} s; "
                "{}",
                path.string(), *options.time_limit, kAdvice)
          : fmt::format("{}: OpenCASCADE cannot read it (its process was {}); "
                        "{}",
                        path.string(), describe_end(end), kAdvice));
}

[[noreturn]] void refuse_writing(const std::filesystem::path& path,
                                 const ChildResult& end) {
  throw MeshError(fmt::format(
      "{}: OpenCASCADE makes no STEP file of the solid (its process was {}); "
      "export it with another --edge, or in another format",
      path.string(), describe_end(end)));
}

}  // namespace

StepChild::StepChild(const std::filesystem::path& path, StepTask task,
                     Monitor* monitor)
    : path_(path), task_(task) {
  constexpr const char* kVariable = "MENISCUS_STEP";
  if (task == StepTask::Read) {
    const auto bytes = static_cast<double>(read_file(path).size());
    options_.time_limit = kLeastTime + kTimePerByte * bytes;
    options_.memory_limit = kLeastMemory + kMemoryPerByte * bytes;
  }
  options_.argv = {require_helper(
      "meniscus-step", kVariable,
      fmt::format("install it in one of these places or set {} to its path",
                  kVariable))};
  options_.monitor = monitor;
  child_ = std::make_unique<AskedChild>(options_);
}

std::string StepChild::ask(const FrameWriter& asked) {
  const auto answer = child_->ask(asked.bytes());
  if (!answer) {
    const ChildResult& end = child_->end();
    if (end.stopped) {
      throw Interrupted(
          fmt::format("stopped on request while a STEP file was {}",
                      task_ == StepTask::Read ? "read" : "written"));
    }
    if (task_ == StepTask::Write) {
      refuse_writing(path_, end);
    }
    refuse_reading(path_, options_, end);
  }
  FrameReader in(*answer);
  const auto kind = in.get<StepAnswer>();
  switch (kind) {
    case StepAnswer::Done:
      return answer->substr(sizeof kind);
    case StepAnswer::IoError:
      throw IoError(in.get_text());
    case StepAnswer::MeshError:
      throw MeshError(in.get_text());
    case StepAnswer::NoMemory:
      if (task_ == StepTask::Write) {
        throw std::bad_alloc();
      }
      throw InvalidInput(
          fmt::format("{}: OpenCASCADE needs more than {:.1f} GB for it; the "
                      "file is damaged, or its faces are far larger than the "
                      "edge length they are read at",
                      path_.string(), *options_.memory_limit / 1e9));
    case StepAnswer::InvalidInput:
      break;
  }
  throw InvalidInput(in.get_text());
}

}  // namespace meniscus::step
