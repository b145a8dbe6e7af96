#include "cad/step/step_solid.h"

#include "cad/step/step_child.h"
#include "cad/step/step_messages.h"

namespace meniscus::step {

ExactShape read_step_solid(const std::filesystem::path& path,
                           const std::string& unit) {
  StepChild child(path, StepTask::Read);
  FrameWriter asked = question(StepQuestion::Solid);
  asked.put_text(path.string());
  asked.put_text(unit);
  const std::string answer = child.ask(asked);
  FrameReader in(answer);
  return read_exact_shape_text(in.get_text());
}

}  // namespace meniscus::step
