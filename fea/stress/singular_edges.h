/// Edges of a part at which linear elasticity knows no finite stress: grooves
/// and the rims of clamps.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/stress/exclusion_zones.h"
#include "fea/stress/patch_recovery.h"

namespace meniscus::stress {

/// Near the tip of a wedge stress grows as r^-order, r the distance from it: 1
/// less the smallest root of the wedge's characteristic equation (M. L.
/// Williams, Stress singularities resulting from various boundary conditions in
/// angular corners of plates in extension, J. Appl. Mech. 19 (1952) 526), in
/// plane strain, the opening mode. `angle` of the material [rad], between 0 and
/// 2 pi. 0 where stress is finite, never above 1/2.
double groove_order(double angle);                 // both sides free
double clamp_order(double angle, double poisson);  // one free, one held

/// An edge where two outer faces of a mesh meet and stress has no limit.
struct SingularEdge {
  Edge corners{};
  std::array<int, 2> labels{};  // of the two faces
  bool clamped = false;         // the first of them is held
  double angle = 0.0;           // of the material, at the edge's middle [rad]
  double order = 0.0;           // > 0
};

/// Edges between faces of different labels, and others that are as sharp as no
/// smooth face makes them. `held`: one char per face, 1 where every component
/// of displacement is fixed; an edge between two held faces counts as free of
/// stress peaks. `mirrors`: the same, 1 in planes of symmetry; empty for none:
/// an edge there is one of the whole, between a face and its image, with twice
/// the angle, and none where the face is held. `poisson`: by region. Not found:
/// where materials meet at the surface, and where a load ends amid a face. By
/// faces, the same for any thread count.
std::vector<SingularEdge> singular_edges(const TetMesh& mesh,
                                         const std::vector<char>& held,
                                         const std::vector<double>& poisson,
                                         const std::vector<char>& mirrors = {});

/// The von Mises stress at a singular edge, and what it would be there with
/// edges `factor` times shorter, by the edge's order.
struct SingularPeak {
  SingularEdge edge;
  Vec3 position = Vec3::Zero();  // [length]
  double von_mises = 0.0;        // recovered [pressure]
  double grown = 0.0;            // [pressure]
};

/// That with the largest `grown`, the first of equals, of what is not excluded;
/// nothing without any.
std::optional<SingularPeak> largest_singular_peak(
    const TetMesh& mesh, const std::vector<SingularEdge>& edges,
    const RecoveredStress& stress, const Excluded& excluded, double factor);

}  // namespace meniscus::stress
