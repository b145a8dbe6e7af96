/// VTK's XML files, for ParaView and for the pictures: volumes as .vtu,
/// surfaces as .vtp. Compressed binary, names and units inside. All throw
/// InvalidInput for fields that do not fit and IoError for the file.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/mesh_checks.h"
#include "core/geometry/surface_mesh.h"
#include "core/geometry/tet_mesh.h"

namespace meniscus::io {

/// Values on points or cells, all components of one before the next. Six
/// components are a symmetric tensor in VTK's order: xx yy zz xy yz xz.
struct Field {
  std::string name;  // "displacement", "von_mises"
  std::string unit;  // "mm", "MPa"; empty: none. Stored as UNITS_LABEL
  int components = 1;
  std::vector<double> values;
};

struct MeshFields {
  std::vector<Field> points;
  std::vector<Field> cells;
  /// Name and text, stored as field data: title, length unit, provenance.
  std::vector<std::pair<std::string, std::string>> notes;
  /// Field data too: names, one text each, and numbers (of one component).
  std::vector<std::pair<std::string, std::vector<std::string>>> lists = {};
  std::vector<Field> numbers = {};
};

/// Tetrahedra with the cell data `region`; of a mesh without any its faces,
/// with `surface` as in write_vtp().
void write_vtu(const std::filesystem::path& path, const TetMesh& mesh,
               const MeshFields& fields = {});

/// Triangles with the cell data `surface` (index into the field data
/// `surface_names`).
void write_vtp(const std::filesystem::path& path, const SurfaceMesh& mesh,
               const MeshFields& fields = {});

/// The boundary of a tetrahedral mesh as triangles, a six-node face cut into
/// four. Point p is the mesh's node `nodes[p]`, facet f belongs to its face
/// `faces[f]`.
struct BoundarySurface {
  SurfaceMesh mesh;
  std::vector<int> nodes;
  std::vector<int> faces;
};
BoundarySurface boundary_surface(const TetMesh& mesh);

/// The boundary of a mesh with point fields given per node of the mesh.
void write_boundary_vtp(const std::filesystem::path& path, const TetMesh& mesh,
                        const MeshFields& fields = {});

/// Findings of check_surface, for the eye: a vertex at every position and the
/// facets named, with the cell data `finding` (index into the field data
/// `messages`) and `kind`.
void write_findings_vtp(const std::filesystem::path& path,
                        const SurfaceMesh& mesh,
                        const std::vector<Finding>& findings);

}  // namespace meniscus::io
