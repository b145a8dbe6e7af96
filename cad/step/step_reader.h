/// STEP in: conventional parts as named surfaces (edges:
/// cad/step/step_edges.h).
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/surface_mesh.h"

namespace meniscus::step {

struct ReadStepOptions {
  std::string unit = "mm";  // that lengths are wanted in: mm, m, in
  double edge = 0.0;        // size of what is of interest [length], > 0: curved
                            // faces are met within a fiftieth of it
};

/// The faces of all solids in the file, tessellated by OpenCASCADE, as one
/// closed body. Each face is a surface by its name in the file (faces of one
/// name together), or "face_7" by its number in the file, from 1, where it has
/// none. Flat faces have long facets. Throws InvalidInput (no STEP, no solid,
/// a face that cannot be tessellated, an unknown unit), IoError when the file
/// cannot be read. One call at a time: OpenCASCADE's settings are the process's
/// own.
SurfaceMesh read_step_part(const std::filesystem::path& path,
                           const ReadStepOptions& options);

}  // namespace meniscus::step
