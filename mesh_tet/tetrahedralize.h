/// Closed labelled surface in, four-node tetrahedra out, the surface kept
/// vertex for vertex (node i is surface point i). TetGen 1.5 runs in a child
/// process with a time and a memory limit, because it ends its process on some
/// inputs (docs/decisions).
#pragma once

#include <optional>
#include <string>

#include "core/error.h"
#include "core/monitor.h"
#include "core/surface_mesh.h"
#include "core/tet_mesh.h"

namespace meniscus {

struct TetrahedralizeOptions {
  std::optional<double> edge;      // target edge inside [length]; automatic:
                                   // the surface's mean edge
  double radius_edge_ratio = 1.4;  // TetGen's quality bound
  double time_limit = 300.0;       // of the child [s]
  double memory_limit = 8e9;       // of the child [byte]
  Monitor* monitor = nullptr;
};

struct TetQuality {
  double min_dihedral_deg = 0.0;
  double max_dihedral_deg = 0.0;
  double max_radius_edge = 0.0;  // circumradius over shortest edge
  double max_aspect = 0.0;       // longest edge over smallest height
  double min_volume = 0.0;       // [length^3]
};

struct Tetrahedralization {
  TetMesh mesh;  // order 1
  TetQuality quality;
  std::optional<Failure> failure;  // then the mesh is empty
  double seconds = 0.0;
};

Tetrahedralization tetrahedralize(const SurfaceMesh& surface,
                                  const TetrahedralizeOptions& options = {});

TetQuality tet_quality(const TetMesh& mesh);

/// Ten-node elements from four-node ones: mid-sides of surface edges on
/// `surface` (whose base is the surface that was filled), of inner edges half
/// way. An element that its curved sides would make invalid (Jacobian not
/// positive at its check points) gets them straightened, together with its
/// neighbours on those edges; `straightened` receives how many edges.
/// `curve_edge` fixes that choice, one flag per surface edge, when given: so
/// that a model makes it once and keeps it.
TetMesh make_quadratic(const TetMesh& linear, const QuadraticSurface& surface,
                       std::vector<char>* curve_edge = nullptr,
                       int* straightened = nullptr);

/// The same topology at other positions: corners from `corner_nodes`,
/// mid-sides as make_quadratic places them. Used for every later design.
void move_quadratic(TetMesh& mesh, const Points& corner_nodes,
                    const QuadraticSurface& surface,
                    const std::vector<char>& curve_edge);

/// First element whose Jacobian determinant is not above `least` x its mean
/// anywhere it is checked, or -1.
int find_inverted(const TetMesh& mesh, double least = 1e-3);

}  // namespace meniscus
