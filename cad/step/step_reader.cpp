#include "cad/step/step_reader.h"

#include <fmt/format.h>

#include "cad/step/step_child.h"
#include "cad/step/step_messages.h"
#include "core/error.h"

namespace meniscus::step {

SurfaceMesh read_step_part(const std::filesystem::path& path,
                           const ReadStepOptions& options) {
  if (!(options.edge > 0.0)) {
    throw InvalidInput(
        fmt::format("the edge length to read '{}' at is {:g}, not above 0",
                    path.string(), options.edge));
  }
  StepChild child(path, StepTask::Read, options.monitor);
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

}  // namespace meniscus::step
