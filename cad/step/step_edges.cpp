#include "cad/step/step_edges.h"

#include "cad/step/step_child.h"
#include "cad/step/step_messages.h"

namespace meniscus::step {

StepEdges::StepEdges(const std::filesystem::path& path, const std::string& unit)
    : child_(std::make_unique<StepChild>(path, StepTask::Read)) {
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
