/// 3MF, what slicers read: closed surfaces with a unit.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"
#include "io/file_notes.h"

namespace meniscus::io {

struct ThreeMfOptions {
  FileNotes notes;                  // metadata; its unit is the file's own
  std::vector<std::string> bodies;  // names, one per body; empty: "body_1"...
};

/// An object of type model for each body, named; several are components of one
/// with the title for a name, which is what the build plate has, as it stands.
/// Facets between two bodies are in both. Coordinates are 32-bit
/// and written to six decimals: 1e-6 of the unit. Same input, same bytes.
/// Throws InvalidInput (no facets, a bad point id, a coordinate that is not
/// finite or at least 2^30 of the unit, a unit other than mm, m and in),
/// IoError.
void write_3mf(const std::filesystem::path& path, const SurfaceMesh& mesh,
               const ThreeMfOptions& options);

}  // namespace meniscus::io
