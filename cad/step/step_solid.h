/// STEP in: a solid as it is, its faces and edges exact.
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/exact_shape.h"

namespace meniscus::step {

/// The one solid of the file; voids within it are faces like others. Faces and
/// edges in the order of their numbers, from 1 (cad/step/step_edges.h), edges
/// without length left in as lines of none that no face uses. A face has its
/// name in the file, or "face_7" by its number where it has none, another has
/// the same, or it is such a number. Surfaces that are neither planes,
/// cylinders, cones, spheres, tori nor splines become splines.
///
/// `unit`: that lengths are wanted in: mm, m or in. Throws InvalidInput (no
/// STEP, no solid or several, one that is not closed: names the edge, an
/// unknown unit, a file that OpenCASCADE cannot read in its process's limits),
/// IoError, Interrupted.
ExactShape read_step_solid(const std::filesystem::path& path,
                           const std::string& unit);

}  // namespace meniscus::step
