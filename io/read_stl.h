/// ASCII STL in: a closed surface whose faces have names.
#pragma once

#include <filesystem>
#include <string>

#include "core/surface_mesh.h"

namespace meniscus {

/// Each `solid NAME ... endsolid` becomes one named surface, the blocks
/// together one body; corners with equal coordinates are one point, facets
/// without area are dropped. Normals in the file are not looked at.
/// Throws InvalidInput ("FILE:LINE: what, found, expected"): a binary file, a
/// solid without a name or with one that another has, anything that is no STL;
/// IoError when the file cannot be read.
SurfaceMesh read_stl(const std::filesystem::path& path);

/// The same from text; `path` for messages.
SurfaceMesh read_stl_text(const std::string& text, const std::string& path);

}  // namespace meniscus
