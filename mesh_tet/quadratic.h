/// Ten-node elements with curved sides from four-node ones.
#pragma once

#include <vector>

#include "core/geometry/surface_mesh.h"
#include "core/geometry/tet_mesh.h"

namespace meniscus::mesh_tet {

/// A curved element is kept while its Jacobian determinant stays above this
/// part of its mean, with room for later designs; else it is straightened.
inline constexpr double kLeastCurvedJacobian = 0.2;

/// Ten-node elements from four-node ones: mid-sides of surface edges on
/// `surface` (whose base is the surface that was filled), of inner edges half
/// way. The mid-side of surface edge i is node corner_count + i, those of
/// inner edges follow. An element that its curved sides would make poor
/// (Jacobian determinant not above kLeastCurvedJacobian x its mean) gets them
/// straightened, also for its neighbours on those edges; `straightened`
/// receives how many edges. `curve_edge` holds that choice, one flag per
/// surface edge: filled when it comes empty, else obeyed, so that a model
/// makes the choice once and keeps it. Throws MeshError when mesh, surface and
/// flags do not fit together.
TetMesh make_quadratic(const TetMesh& linear, const QuadraticSurface& surface,
                       std::vector<char>* curve_edge = nullptr,
                       int* straightened = nullptr);

/// The same topology at other positions: corners from `corner_nodes`,
/// mid-sides as make_quadratic places them. Used for every later design.
void move_quadratic(TetMesh& mesh, const Points& corner_nodes,
                    const QuadraticSurface& surface,
                    const std::vector<char>& curve_edge);

struct QuadraticGradient {
  Points corners;  // by corner_nodes of move_quadratic
  Points mid;      // by surface.mid; zero where the edge is straight
};

/// Transpose of move_quadratic: a gradient by all nodes of the ten-node mesh,
/// as one by what the nodes were made from.
QuadraticGradient transpose_quadratic(const TetMesh& mesh,
                                      const Points& node_gradient,
                                      const std::vector<char>& curve_edge);

/// First element whose Jacobian determinant is not above `least` x its mean
/// everywhere, or -1. The determinant is a cubic polynomial on the element: it
/// is bounded by its Bernstein coefficients, on parts of the element where
/// that does not decide (Johnen, Remacle, Geuzaine 2013).
int find_inverted(const TetMesh& mesh, double least = 1e-3);

/// Smallest value over the element of its Jacobian determinant over the
/// determinant's mean, to within about 1 % from below. 1 for straight sides.
double jacobian_ratio(const TetMesh& mesh, int element);

}  // namespace meniscus::mesh_tet
