/// STEP in: conventional parts as named surfaces (edges:
/// cad/step/step_edges.h).
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/surface_mesh.h"
#include "core/monitor.h"

namespace meniscus::step {

struct ReadStepOptions {
  std::string unit = "mm";  // that lengths are wanted in: mm, m, in
  double edge = 0.0;        // size of what is of interest [length], > 0: curved
                            // faces are met within a fiftieth of it
  Monitor* monitor = nullptr;  // asked every 50 ms whether to stop
};

/// The faces of all solids in the file, tessellated by OpenCASCADE, as one
/// closed body. Each face is a surface by its name in the file (faces of one
/// name together), or "face_7" by its number in the file, from 1, where it has
/// none. Flat faces have long facets. Throws InvalidInput (no STEP, no solid,
/// a face that cannot be tessellated, an unknown unit, a file that OpenCASCADE
/// cannot read in its process's limits: cad/step/step_child.h), IoError when
/// the file cannot be read, Interrupted.
SurfaceMesh read_step_part(const std::filesystem::path& path,
                           const ReadStepOptions& options);

}  // namespace meniscus::step
