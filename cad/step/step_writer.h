/// STEP out: solids of planes, cylinders, spheres and B-spline faces with names
/// (AP214).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cad/solid/brep.h"
#include "core/monitor.h"

namespace meniscus::step {

struct StepOptions {
  std::string name;            // of the part
  std::string unit = "mm";     // of the solid's lengths and the file: mm, m, in
  Monitor* monitor = nullptr;  // asked every 50 ms whether to stop
};

struct StepPart {
  std::string name;
  solid::Brep brep;
};

/// What OpenCASCADE found of the solids that were written, together, in their
/// unit.
struct StepReport {
  int shells = 0;
  double volume = 0.0;
  Vec3 mass_center = Vec3::Zero();
  double tolerance = 0.0;  // the largest of edges and vertices
};

/// Writes the closed solid; the same bits for the same input (the header's time
/// is 1970). Throws MeshError for faces that make no valid closed solid
/// (BRepCheck_Analyzer's first finding is in the message) or that end
/// OpenCASCADE's process, InvalidInput for an unknown unit, IoError (also: no
/// helper, cad/step/step_child.h), Interrupted, which leaves what was there.
StepReport write_step(const std::filesystem::path& path,
                      const solid::Brep& brep, const StepOptions& options = {});

/// The same of several solids, each a part of its own name.
StepReport write_step(const std::filesystem::path& path,
                      const std::vector<StepPart>& parts,
                      const StepOptions& options);

}  // namespace meniscus::step
