#include "fea/shell/shell_held.h"

#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "core/math/union_find.h"
#include "fea/shell/facet_rule.h"

namespace meniscus::shell {

namespace {

/// How well the least held motion is held, of how the best is: two nodes h
/// apart hold the turn of a part of size L by (h / L)^2, rounding leaves 1e-14.
constexpr double kHeld = 1e-11;

/// A node's six numbers under six motions: along x y z, and turns about the
/// part's center by which `size` moves 1; rotations times `size`.
Matrix6 rigid_motions(const Vec3& arm, double size) {
  Matrix6 R = Matrix6::Identity();
  for (int k = 0; k < 3; ++k) {
    R.block<3, 1>(0, 3 + k) = Vec3::Unit(k).cross(arm) / size;
  }
  return R;
}

std::string motion_text(const Eigen::Matrix<double, 6, 1>& motion) {
  const bool turns = motion.tail<3>().norm() > motion.head<3>().norm();
  const Vec3 way = (turns ? motion.tail<3>() : motion.head<3>()).normalized();
  return fmt::format("{} ({:.3g}, {:.3g}, {:.3g})",
                     turns ? "turn about" : "move along", way[0], way[1],
                     way[2]);
}

}  // namespace

void check_held(const ShellMesh& mesh, const ShellFreedom& freedom) {
  const int nodes = freedom.nodes();
  UnionFind pieces(nodes);
  for (const auto& facet : mesh.facets) {
    for (int k = 1; k < kNodes; ++k) {
      pieces.join(facet[0], facet[k]);
    }
  }
  std::vector<std::vector<int>> members(nodes);
  for (int i = 0; i < nodes; ++i) {
    members[pieces.root(i)].push_back(i);
  }
  for (const std::vector<int>& piece : members) {
    if (piece.empty()) {
      continue;
    }
    Vec3 center = Vec3::Zero();
    for (const int i : piece) {
      center += mesh.nodes[i] / static_cast<double>(piece.size());
    }
    double size = 0.0;
    for (const int i : piece) {
      size = std::max(size, (mesh.nodes[i] - center).norm());
    }
    Matrix6 held = Matrix6::Zero();
    for (const int i : piece) {
      if (freedom.free_count(i) < 6) {
        const auto Q = freedom.basis(i);
        const Matrix6 R = rigid_motions(mesh.nodes[i] - center, size);
        const Matrix6 P = Matrix6::Identity() - Q * Q.transpose();
        held += R.transpose() * P * R;
      }
    }
    const auto motions = symmetric_eigen(held);
    if (!(motions.values[0] > kHeld * motions.values[5])) {
      throw SolverError(fmt::format(
          "a shell of {} nodes around ({:.6g}, {:.6g}, {:.6g}) is free to {}; "
          "hold more of it",
          piece.size(), center[0], center[1], center[2],
          motion_text(motions.vectors.col(0))));
    }
  }
}

}  // namespace meniscus::shell
