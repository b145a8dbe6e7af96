/// Harmonic functions on triangle meshes, by cotangent weights (Pinkall,
/// Polthier 1993).
#pragma once

#include <array>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus {

enum class HarmonicWeights {
  /// Of every facet held above zero: maps onto convex outlines are one to one
  /// on any mesh (Tutte 1963; Floater 2003), and obtuse facets too stiff.
  Positive,
  /// The energy's own, second order on any mesh.
  Exact,
};

struct HarmonicProblem {
  const Points& points;
  const std::vector<Triangle>& mesh;
  std::vector<int> facets;  // of the mesh, that the functions live on
  std::vector<char> fixed;  // one per point
  Eigen::MatrixXd values;   // a row per vertex: the fixed ones'
  // What a corner's value exceeds its vertex's by, per facet of `facets`;
  // empty: nothing. For functions that gain 1 around a tube.
  std::vector<std::array<int, 3>> offsets = {};
  HarmonicWeights weights = HarmonicWeights::Positive;
  // Of each facet of the mesh, above 0: where it is large the functions are
  // flatter; empty: 1.
  std::vector<double> stiffness = {};
};

/// The values at all points of the facets; others keep theirs. Each connected
/// part needs a fixed point. Throws MeshError where nothing is fixed, and where
/// rounding does not hide that a part has none.
Eigen::MatrixXd harmonic(const HarmonicProblem& problem);

/// Corner offsets of the tube between two loops, and the path of vertices from
/// the first loop to the second across which functions jump: they gain 1 along
/// the first loop's direction.
struct TubeCut {
  std::vector<int> path;
  std::vector<std::array<int, 3>> offsets;
};
/// `points`: how many the mesh has. Throws MeshError where the facets do not
/// connect the loops.
TubeCut cut_tube(const std::vector<Triangle>& mesh, std::size_t points,
                 const std::vector<int>& facets, const std::vector<int>& first,
                 const std::vector<int>& second);

}  // namespace meniscus
