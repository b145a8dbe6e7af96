/// How a solid's displacements move the edges that are tied to it, and how that
/// changes with the nodes' places.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/types.h"
#include "fea/joint/edge_tie.h"
#include "fea/shell/shell_supports.h"

namespace meniscus::joint {

/// The six numbers of a tied node: sum of by_solid times the displacements of
/// the solid's nodes, and by_turn times its own turn about the last axis.
struct TieRow {
  int node = 0;                                       // of the shell
  std::vector<int> solid;                             // of the solid, ascending
  std::vector<Eigen::Matrix<double, 6, 3>> by_solid;  // one each
  shell::Six by_turn = shell::Six::Zero();
};

/// One per tied node; `solid`, `shell`: places of all nodes.
std::vector<TieRow> tie_rows(const EdgeTie& tie, const Points& solid,
                             const Points& shell);

/// Mean of |r|^2 I - r r^T over the arms r of a node's fibres [length^2].
Mat3 mean_arms(const EdgeTie& tie, const TiedNode& node, const Points& solid);

/// Adds the gradient of p . T v by places, T the tie at these, v and p held.
/// `solid_motion`: 3 per node of the solid; `shell_motion`: 6 per node, at tied
/// nodes T v; `forces` p: 6 per node, of which tied nodes' count.
void add_tie_gradient(const EdgeTie& tie, const Points& solid,
                      const Points& shell, const VectorX& solid_motion,
                      const VectorX& shell_motion, const VectorX& forces,
                      Points& by_solid, Points& by_shell);

}  // namespace meniscus::joint
