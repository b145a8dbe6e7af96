/// One round of adaptive refinement: where a mesh should be finer.
#pragma once

#include <functional>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/tet_mesh.h"
#include "pipeline/forward/element_errors.h"

namespace meniscus::forward {

/// What to ask of TetGen (TetrahedralizeOptions) where edges halve from one
/// facet to the next: at its usual 1.4 and 15 degrees it takes a third more
/// elements for the same error, and splits without end on some surfaces.
inline constexpr double kGradedRadiusEdge = 1.6;
inline constexpr double kGradedDihedral = 12.0;

struct RefinementPlan {
  std::vector<char> split;  // per boundary face of the mesh: halve its edges
  std::function<double(const Vec3&)> size;  // edge wanted at a place [length]
};

/// Should leave 40 % of the error with the fewest elements
/// (fea/stress/size_field.h: smooth stresses), no edge by more than one half: a
/// surface has no finer nodes. `share`: per element its part of the error, as
/// ElementErrors has it.
RefinementPlan plan_refinement(const TetMesh& mesh,
                               const std::vector<double>& share);

/// The initial design on one mesh.
struct AdaptedState {
  TetFigures tet;
  int dofs = 0;
  VectorX responses;
  ElementErrors errors;
};

struct Adaptation {
  AdaptedState before;
  AdaptedState after;
};

/// result.json's "adaptation" (docs/results.md).
nlohmann::ordered_json adaptation_json(const case_data::Case& input,
                                       const Adaptation& adaptation);

}  // namespace meniscus::forward
