/// STL in: a closed surface, from ASCII files with named faces.
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/surface_mesh.h"

namespace meniscus::io {

/// ASCII: each `solid NAME ... endsolid` becomes one named surface, the blocks
/// together one body. Binary (84 bytes and 50 a facet): all one surface,
/// "unnamed", for the format has no names. Corners with equal coordinates are
/// one point, facets without area are dropped. Normals in the file are not
/// looked at.
/// Throws InvalidInput ("FILE:LINE: what, found, expected"): a binary file of
/// another size or with coordinates that are not finite, a solid without a name
/// or with one that another has, anything that is no STL; IoError when the file
/// cannot be read.
SurfaceMesh read_stl(const std::filesystem::path& path);

/// The same from text; `path` for messages.
SurfaceMesh read_stl_text(const std::string& text, const std::string& path);

}  // namespace meniscus::io
