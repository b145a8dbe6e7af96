#include "fea/holding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/constrain.h"
#include "fea/held_check.h"
#include "fea/supports.h"

namespace meniscus {

bool Holding::operator==(const Holding& other) const {
  return fixed == other.fixed && oblique.held == other.oblique.held &&
         oblique.projector == other.oblique.projector &&
         springs == other.springs;
}

void check_holding(const TetMesh& mesh, const LoadCase& load_case) {
  std::vector<HeldDirection> held = held_directions(mesh, load_case);
  const std::vector<HeldDirection> sprung = sprung_directions(mesh, load_case);
  held.insert(held.end(), sprung.begin(), sprung.end());
  if (held.empty()) {
    throw InvalidInput(fmt::format(
        "load case '{}' has no support: fix x, y, z or the normal of a surface",
        load_case.name));
  }
  check_held(mesh, held, load_case.name);
}

Holding make_holding(const TetMesh& mesh, const LoadCase& load_case,
                     const NodeOrder& order) {
  const NodeFreedom given =
      node_freedom(mesh, held_directions(mesh, load_case));
  Holding holding;
  holding.fixed.assign(3 * mesh.nodes.size(), 1);  // nodes in no element
  for (const int node : mesh.elements) {
    std::fill_n(holding.fixed.begin() + 3L * order.to_solver[node], 3, 0);
  }
  std::vector<std::pair<int, Mat3>> oblique;
  for (std::size_t h = 0; h < given.held.size(); ++h) {
    const Mat3& P = given.projector[h];
    const int node = order.to_solver[given.held[h]];
    if (P == Mat3(P.diagonal().asDiagonal())) {
      for (int k = 0; k < 3; ++k) {
        holding.fixed[3L * node + k] |= P(k, k) == 0.0 ? 1 : 0;
      }
    } else {
      oblique.emplace_back(node, P);
    }
  }
  std::sort(oblique.begin(), oblique.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  holding.oblique.nodes = given.nodes;
  for (const auto& [node, P] : oblique) {
    holding.oblique.held.push_back(node);
    holding.oblique.projector.push_back(P);
  }
  holding.springs =
      renumbered(spring_blocks(mesh, load_case, mesh.order), order.to_solver);
  return holding;
}

bool alike(const Holding& a, const Holding& b) {
  const auto same_rank = [](const Mat3& P, const Mat3& Q) {
    return std::lround(P.trace()) == std::lround(Q.trace());
  };
  return a.fixed == b.fixed && a.oblique.held == b.oblique.held &&
         std::equal(a.oblique.projector.begin(), a.oblique.projector.end(),
                    b.oblique.projector.begin(), same_rank);
}

int free_unknowns(const Holding& holding) {
  double free = static_cast<double>(
      std::count(holding.fixed.begin(), holding.fixed.end(), 0));
  for (const Mat3& P : holding.oblique.projector) {
    free -= 3.0 - P.trace();
  }
  return static_cast<int>(std::lround(free));
}

BlockMatrix<double> held_matrix(const BlockPattern& pattern,
                                const BlockMatrix<double>& matrix,
                                const Holding& holding) {
  BlockMatrix<double> held = matrix;
  add_springs(pattern, holding.springs, held);
  constrain(pattern, holding.oblique, held);
  return held;
}

NodeFreedom corner_freedom(const NodeFreedom& fine,
                           const std::vector<int>& corner) {
  NodeFreedom result{static_cast<int>(corner.size()), {}, {}};
  for (std::size_t h = 0; h < fine.held.size(); ++h) {
    const auto at =
        std::lower_bound(corner.begin(), corner.end(), fine.held[h]);
    if (at != corner.end() && *at == fine.held[h]) {
      result.held.push_back(static_cast<int>(at - corner.begin()));
      result.projector.push_back(fine.projector[h]);
    }
  }
  return result;
}

}  // namespace meniscus
