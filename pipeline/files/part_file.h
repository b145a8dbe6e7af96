/// Surfaces of parts that other programs wrote.
#pragma once

#include <filesystem>

#include "cad/step/step_reader.h"
#include "core/geometry/surface_mesh.h"

namespace meniscus::files {

/// A file's name ends as those of parts that can be read: .stl, .obj, .step,
/// .stp, .fe, in any case.
bool is_part_file(const std::filesystem::path& path);

/// Are the faces of such a file curved, and facets only what is made of them?
bool has_curved_faces(const std::filesystem::path& path);

/// The closed surface of such a file, its faces by name; `options` say how
/// curved faces become facets. Throws what the format's reader throws,
/// InvalidInput for another ending.
SurfaceMesh read_part_file(const std::filesystem::path& path,
                           const step::ReadStepOptions& options);

}  // namespace meniscus::files
