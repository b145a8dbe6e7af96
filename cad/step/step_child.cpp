#include "cad/step/step_child.h"

#include <cmath>

#include <fmt/format.h>

#include "cad/step/step_edges.h"
#include "cad/step/step_messages.h"
#include "cad/step/step_reader.h"
#include "cad/step/step_solid.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/find_program.h"

namespace meniscus::step {

namespace {

constexpr double kLeastTime = 10.0;  // [s]
constexpr double kTimePerByte = 20e-6;
constexpr double kLeastMemory = 0.9e9;  // [byte] of address space
constexpr double kMemoryPerByte = 500.0;

std::string no_answer(const std::filesystem::path& path,
                      const ChildOptions& options, const ChildResult& end) {
  constexpr const char* kAdvice =
      "the file is damaged or too large; write it anew from its CAD program";
  return end.timed_out
             ? fmt::format(
                   "{}: OpenCASCADE did not come to an end with it in "
                   "{:.0f} s; {}",
                   path.string(), *options.time_limit, kAdvice)
             : fmt::format(
                   "{}: OpenCASCADE cannot read it (its process was "
                   "{}); {}",
                   path.string(), describe_end(end), kAdvice);
}

FrameWriter question(StepQuestion kind) {
  FrameWriter out;
  out.put(kind);
  return out;
}

}  // namespace

StepChild::StepChild(const std::filesystem::path& path, Monitor* monitor)
    : path_(path) {
  constexpr const char* kVariable = "MENISCUS_STEP";
  const auto bytes = static_cast<double>(read_file(path).size());
  options_.argv = {require_helper(
      "meniscus-step", kVariable,
      fmt::format("install it in one of these places or set {} to its path",
                  kVariable))};
  options_.time_limit = kLeastTime + kTimePerByte * bytes;
  options_.memory_limit = kLeastMemory + kMemoryPerByte * bytes;
  options_.monitor = monitor;
  child_ = std::make_unique<AskedChild>(options_);
}

std::string StepChild::ask(const FrameWriter& asked) {
  const auto answer = child_->ask(asked.bytes());
  if (!answer) {
    if (child_->end().stopped) {
      throw Interrupted("stopped on request while a STEP file was read");
    }
    throw InvalidInput(no_answer(path_, options_, child_->end()));
  }
  FrameReader in(*answer);
  const auto kind = in.get<StepAnswer>();
  switch (kind) {
    case StepAnswer::Done:
      return answer->substr(sizeof kind);
    case StepAnswer::IoError:
      throw IoError(in.get_text());
    case StepAnswer::NoMemory:
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

SurfaceMesh read_step_part(const std::filesystem::path& path,
                           const ReadStepOptions& options) {
  if (!(options.edge > 0.0)) {
    throw InvalidInput(
        fmt::format("the edge length to read '{}' at is {:g}, not above 0",
                    path.string(), options.edge));
  }
  StepChild child(path, options.monitor);
  FrameWriter asked = question(StepQuestion::Part);
  asked.put_text(path.string());
  asked.put_text(options.unit);
  asked.put(options.edge);
  const std::string answer = child.ask(asked);
  FrameReader in(answer);
  SurfaceMesh mesh = get_mesh(in);
  for (const Vec3& p : mesh.points) {
    if (!p.allFinite()) {
      throw InvalidInput(fmt::format(
          "{}: a face of it has a point that is not finite", path.string()));
    }
  }
  return mesh;
}

ExactShape read_step_solid(const std::filesystem::path& path,
                           const std::string& unit) {
  StepChild child(path);
  FrameWriter asked = question(StepQuestion::Solid);
  asked.put_text(path.string());
  asked.put_text(unit);
  const std::string answer = child.ask(asked);
  FrameReader in(answer);
  return read_exact_shape_text(in.get_text());
}

StepEdges::StepEdges(const std::filesystem::path& path, const std::string& unit)
    : child_(std::make_unique<StepChild>(path)) {
  FrameWriter asked = question(StepQuestion::Open);
  asked.put_text(path.string());
  asked.put_text(unit);
  child_->ask(asked);
}
StepEdges::StepEdges(StepEdges&&) noexcept = default;
StepEdges& StepEdges::operator=(StepEdges&&) noexcept = default;
StepEdges::~StepEdges() = default;

StepLoop StepEdges::loop(const std::vector<std::string>& edges) const {
  FrameWriter asked = question(StepQuestion::Loop);
  asked.put(static_cast<std::uint64_t>(edges.size()));
  for (const std::string& edge : edges) {
    asked.put_text(edge);
  }
  const std::string answer = child_->ask(asked);
  FrameReader in(answer);
  return get_loop(in);
}

StepLoop StepEdges::rim(const std::string& face) const {
  FrameWriter asked = question(StepQuestion::Rim);
  asked.put_text(face);
  const std::string answer = child_->ask(asked);
  FrameReader in(answer);
  return get_loop(in);
}

}  // namespace meniscus::step
