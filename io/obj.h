/// Wavefront OBJ: facets with an object per body and a group per surface.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"
#include "io/file_notes.h"

namespace meniscus::io {

struct ObjOptions {
  FileNotes notes;                  // into comments at the head; no unit else
  std::vector<std::string> bodies;  // names, one per body; empty: "body_1"...
};

/// Coordinates with all digits, corners shared. Each body is an object `o`,
/// closed, its facets in groups `g` of the surfaces' names; facets between two
/// bodies are in both. Spaces in names become '_'. Throws InvalidInput (no
/// facets, a bad point id, a coordinate that is not finite) and IoError.
void write_obj(const std::filesystem::path& path, const SurfaceMesh& mesh,
               const ObjOptions& options = {});

/// A closed surface whose faces are the file's groups (`g`; `o` where there is
/// none; facets before the first are "unnamed"), all bodies as one. Faces with
/// more than three corners are cut into triangles from their first corner;
/// corners with equal coordinates are one point, facets without area are
/// dropped. Texture, normals, materials, lines and free points are left out.
/// Throws InvalidInput ("FILE:LINE: what, found, expected"), IoError.
SurfaceMesh read_obj(const std::filesystem::path& path);

/// The same from text; `path` for messages.
SurfaceMesh read_obj_text(const std::string& text, const std::string& path);

}  // namespace meniscus::io
