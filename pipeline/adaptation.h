/// One round of adaptive refinement: where a mesh should be finer.
#pragma once

#include <functional>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/tet_mesh.h"
#include "pipeline/element_errors.h"

namespace meniscus {

struct RefinementPlan {
  std::vector<char> split;  // per boundary face of the mesh: halve its edges
  std::function<double(const Vec3&)> size;  // edge wanted at a place [length]
};

/// Halves the error with the fewest elements (fea/size_field.h), no edge by
/// more than one half: a surface has no finer nodes. `share`: per element its
/// part of the error, as ElementErrors has it.
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
nlohmann::ordered_json adaptation_json(const Case& input,
                                       const Adaptation& adaptation);

}  // namespace meniscus
