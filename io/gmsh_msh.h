/// Gmsh's mesh file, version 4.1 in text: also what meshio, FEniCS, Elmer and
/// code_aster take.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "io/file_notes.h"

namespace meniscus::io {

/// Values at all nodes, which Gmsh shows as a view. `values`: all components
/// of a node before the next node's.
struct MshField {
  std::string name;    // with its unit: "displacement [mm]"
  int components = 1;  // 1 or 3
  std::vector<double> values;
};

struct MshOptions {
  FileNotes notes;                   // comments
  std::vector<std::string> regions;  // names, one per region; empty: "body_1"
  std::vector<MshField> fields;
};

/// Elements of the mesh's order and, of the same order, its faces. Node and
/// element n has number n + 1, faces follow the elements. Physical volumes are
/// named after the regions, physical surfaces after the labels; the surface of
/// one name between the same bodies is one discrete entity. Of a mesh without
/// elements the faces alone. Throws InvalidInput
/// for fields that do not fit, IoError.
void write_msh(const std::filesystem::path& path, const TetMesh& mesh,
               const MshOptions& options = {});

}  // namespace meniscus::io
