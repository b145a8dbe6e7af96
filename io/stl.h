/// Binary STL: facets and their normals, no names, no unit of its own.
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/surface_mesh.h"

namespace meniscus::io {

/// Of binary files, each: normal, corners, two bytes more.
inline constexpr std::size_t kStlFacetBytes = 50;

struct StlOptions {
  std::string name;  // goes, shortened, into the 80-byte header
  std::string unit;  // of the coordinates, into the header: "mm"
  std::string program = "Meniscus";  // before the name, with its version
};

/// Coordinates become 32-bit floats. Throws InvalidInput (no facets, a bad
/// point id, a coordinate that is not finite or too large) and IoError.
void write_stl(const std::filesystem::path& path, const SurfaceMesh& mesh,
               const StlOptions& options = {});

}  // namespace meniscus::io
