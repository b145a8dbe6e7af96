#include "fea/joint/joint_held.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "core/math/union_find.h"
#include "fea/shell/shell_held.h"

namespace meniscus::joint {

namespace {

/// Nodes that hang together, and what holds them.
struct Piece {
  std::vector<int> nodes;
  Vec3 center = Vec3::Zero();
  double size = 0.0;  // about the center
  Matrix6 held = Matrix6::Zero();
};

}  // namespace

void check_held(const TetMesh& solid,
                const std::vector<supports::HeldDirection>& held,
                const shell::ShellMesh& mesh,
                const shell::ShellFreedom& freedom,
                const std::vector<TieRow>& tie) {
  const auto first = static_cast<int>(solid.nodes.size());
  const auto place = [&](int node) -> const Vec3& {
    return node < first ? solid.nodes[node] : mesh.nodes[node - first];
  };
  UnionFind joined(solid.nodes.size() + mesh.nodes.size());
  std::vector<char> used(joined.size(), 0);
  const auto join_all = [&](const auto& nodes, int offset) {
    for (const int node : nodes) {
      joined.join(nodes[0] + offset, node + offset);
      used[node + offset] = 1;
    }
  };
  for (int e = 0; e < solid.element_count(); ++e) {
    join_all(solid.element(e), 0);
  }
  for (const auto& facet : mesh.facets) {
    join_all(facet, first);
  }
  std::vector<char> tied(mesh.nodes.size(), 0);
  for (const TieRow& row : tie) {
    tied[row.node] = 1;
    joined.join(row.node + first, row.solid.front());
  }
  std::map<int, Piece> pieces;
  for (std::size_t k = 0; k < used.size(); ++k) {
    if (used[k] != 0) {
      const auto node = static_cast<int>(k);
      pieces[joined.root(node)].nodes.push_back(node);
    }
  }
  for (auto& [root, piece] : pieces) {
    const auto count = static_cast<double>(piece.nodes.size());
    for (const int node : piece.nodes) {
      piece.center += place(node) / count;
    }
    for (const int node : piece.nodes) {
      piece.size = std::max(piece.size, (place(node) - piece.center).norm());
    }
  }
  const auto motions = [&](const Piece& piece, int node) {
    return shell::rigid_motions(place(node) - piece.center, piece.size);
  };
  for (const supports::HeldDirection& own : held) {
    if (used[own.node] != 0) {
      Piece& piece = pieces[joined.root(own.node)];
      const Eigen::Matrix<double, 1, 6> row =
          own.direction.transpose() * motions(piece, own.node).topRows<3>();
      piece.held += row.transpose() * row;
    }
  }
  for (int node = 0; node < freedom.nodes(); ++node) {
    if (tied[node] == 0 && freedom.free_count(node) < 6) {
      Piece& piece = pieces[joined.root(node + first)];
      const auto Q = freedom.basis(node);
      const Matrix6 R = motions(piece, node + first);
      piece.held +=
          R.transpose() * (Matrix6::Identity() - Q * Q.transpose()) * R;
    }
  }
  for (const auto& [root, piece] : pieces) {
    const auto found = symmetric_eigen(piece.held);
    if (!(found.values[0] > shell::kHeld * found.values[5])) {
      throw SolverError(fmt::format(
          "a part of {} nodes, of solids and shells, around ({:.6g}, {:.6g}, "
          "{:.6g}) is free to {}; hold more of it, or let the shell's edge lie "
          "on the solid's surface",
          piece.nodes.size(), piece.center[0], piece.center[1], piece.center[2],
          shell::motion_text(found.vectors.col(0))));
    }
  }
}

}  // namespace meniscus::joint
