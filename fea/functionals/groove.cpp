#include "fea/functionals/groove.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/outer_edges.h"

namespace meniscus::functionals {

element::Functional groove_functional(const TetMesh& mesh, double sharpness,
                                      element::Derivatives derivatives) {
  // 1. The turns, and the largest.
  const element::FaceQuadrature at_nodes(mesh.order, element::FaceRule::Nodes);
  std::vector<element::OuterEdge> edges = element::outer_edges(mesh);
  std::erase_if(edges, [&](const element::OuterEdge& edge) {
    return mesh.face_label[edge.face[0]] == mesh.face_label[edge.face[1]];
  });
  if (!(sharpness > 0.0) || !std::isfinite(sharpness) || edges.empty()) {
    throw InvalidInput(fmt::format(
        "groove: sharpness {} over {} edges where two surfaces meet; both must "
        "be above 0",
        sharpness, edges.size()));
  }
  std::vector<element::Turn> turns;
  turns.reserve(edges.size());
  double largest = -std::numeric_limits<double>::infinity();
  for (const element::OuterEdge& edge : edges) {
    turns.push_back(element::turn_of(mesh, at_nodes, edge));
    largest = std::max(largest, turns.back().value);
  }
  // 2. Their smooth maximum.
  double sum = 0.0;
  for (const element::Turn& turn : turns) {
    sum += std::exp(sharpness * (turn.value - largest));
  }
  element::Functional result{.value = largest + std::log(sum) / sharpness};
  if (derivatives == element::Derivatives::All) {
    result.by_nodes.assign(mesh.nodes.size(), Vec3::Zero());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double share =
          std::exp(sharpness * (turns[i].value - largest)) / sum;
      for (std::size_t s = 0; s < 2; ++s) {
        at_nodes.pull_back(mesh, edges[i].face[s], edges[i].place[s],
                           Vec3::Zero(), share * turns[i].by_normal[s],
                           result.by_nodes);
      }
    }
  }
  return result;
}

}  // namespace meniscus::functionals
