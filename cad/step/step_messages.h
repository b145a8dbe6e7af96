/// Internal: what the program and its helper `meniscus-step` say to each other
/// (core/frame.h), both from one build.
#pragma once

#include <cstdint>

#include "cad/step/step_edges.h"
#include "cad/step/step_writer.h"
#include "core/frame.h"
#include "core/geometry/surface_mesh.h"

namespace meniscus::step {

/// First in a question; then its arguments, texts but for the edge's length and
/// the Brep (cad/step/brep_message.h).
enum class StepQuestion : std::int32_t {
  Part,   // path, unit, edge: a mesh
  Open,   // path, unit: nothing
  Loop,   // names' number, names: a loop of the open file
  Rim,    // face: the same
  Solid,  // path, unit: a text (exact_shape_text)
  Write   // path, name, unit, parts' number, name and Brep of each: a report,
          // the file's text
};

/// First in an answer; behind any but Done a message.
enum class StepAnswer : std::int32_t {
  Done,
  InvalidInput,
  IoError,
  MeshError,
  NoMemory
};

/// A message that begins with the question.
FrameWriter question(StepQuestion kind);

/// Throws IoError: program and helper are not of one build.
[[noreturn]] void refuse_message();

void put_mesh(FrameWriter& out, const SurfaceMesh& mesh);
SurfaceMesh get_mesh(FrameReader& in);
void put_loop(FrameWriter& out, const StepLoop& loop);
StepLoop get_loop(FrameReader& in);
void put_report(FrameWriter& out, const StepReport& report);
StepReport get_report(FrameReader& in);

}  // namespace meniscus::step
