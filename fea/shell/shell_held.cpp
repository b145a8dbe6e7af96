#include "fea/shell/shell_held.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "core/math/union_find.h"
#include "fea/shell/facet_rule.h"

namespace meniscus::shell {

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

namespace {

/// Facets that hang together, by rigid rims too.
struct Piece {
  std::vector<int> nodes;
  std::vector<int> rims;  // their seats
  Vec3 center = Vec3::Zero();
  double size = 0.0;  // about the center
};

std::vector<Piece> pieces_of(const ShellMesh& mesh,
                             const ShellFreedom& freedom) {
  const auto nodes = static_cast<int>(mesh.nodes.size());
  UnionFind joined(freedom.seats());
  for (const auto& facet : mesh.facets) {
    for (int k = 0; k < kNodes; ++k) {
      joined.join(facet[0], facet[k]);
      joined.join(facet[k], freedom.seat(facet[k]));
    }
  }
  std::vector<Piece> all(freedom.seats());
  for (int i = 0; i < nodes; ++i) {
    all[joined.root(i)].nodes.push_back(i);
  }
  for (int rim = nodes; rim < freedom.seats(); ++rim) {
    all[joined.root(rim)].rims.push_back(rim);
  }
  std::vector<Piece> pieces;
  for (Piece& piece : all) {
    if (piece.nodes.empty()) {
      continue;
    }
    const auto count = static_cast<double>(piece.nodes.size());
    for (const int i : piece.nodes) {
      piece.center += mesh.nodes[i] / count;
    }
    for (const int i : piece.nodes) {
      piece.size = std::max(piece.size, (mesh.nodes[i] - piece.center).norm());
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

/// By node: the directions that springs pull it along, as a projector would.
std::map<int, Mat3> sprung(const std::vector<GroundSpring>& springs) {
  std::map<int, Mat3> sum;
  for (const GroundSpring& spring : springs) {
    if (spring.at == spring.from) {
      sum.try_emplace(spring.at, Mat3::Zero()).first->second += spring.block;
    }
  }
  for (auto& [node, block] : sum) {
    block /= std::max(block.trace(), std::numeric_limits<double>::min());
  }
  return sum;
}

/// Those of a piece's rigid motions, one a column, that supports and springs
/// leave it.
Eigen::MatrixXd motions_left(const ShellMesh& mesh, const ShellFreedom& freedom,
                             const Piece& piece,
                             const std::map<int, Mat3>& springs) {
  Matrix6 held = Matrix6::Zero();
  const auto hold = [&](int seat, const Vec3& place) {
    const auto Q = freedom.basis(seat);
    if (Q.cols() < 6) {
      const Matrix6 R = rigid_motions(place - piece.center, piece.size);
      const Matrix6 P = Matrix6::Identity() - Q * Q.transpose();
      held += R.transpose() * P * R;
    }
  };
  for (const int i : piece.nodes) {
    if (freedom.seat(i) == i) {
      hold(i, mesh.nodes[i]);
    }
    if (const auto pull = springs.find(i); pull != springs.end()) {
      const Matrix6 R = rigid_motions(mesh.nodes[i] - piece.center, piece.size);
      held += R.topRows<3>().transpose() * pull->second * R.topRows<3>();
    }
  }
  for (const int rim : piece.rims) {
    hold(rim, freedom.rims()[rim - freedom.nodes()].point);
  }
  const auto motions = symmetric_eigen(held);
  Eigen::Index left = 0;
  while (left < 6 && !(motions.values[left] > kHeld * motions.values[5])) {
    ++left;
  }
  return motions.vectors.leftCols(left);
}

}  // namespace

Eigen::MatrixXd free_motions(const ShellMesh& mesh,
                             const ShellFreedom& freedom) {
  std::vector<VectorX> columns;
  for (const Piece& piece : pieces_of(mesh, freedom)) {
    const Eigen::MatrixXd left = motions_left(mesh, freedom, piece, {});
    for (Eigen::Index k = 0; k < left.cols(); ++k) {
      VectorX six = VectorX::Zero(6L * freedom.nodes());
      for (const int i : piece.nodes) {
        six.segment<6>(6L * i) =
            rigid_motions(mesh.nodes[i] - piece.center, piece.size) *
            left.col(k);
        six.segment<3>(6L * i + 3) /= piece.size;
      }
      columns.push_back(freedom.unknowns_of(six));
    }
  }
  Eigen::MatrixXd motions(freedom.unknowns(),
                          static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    motions.col(static_cast<Eigen::Index>(k)) = columns[k];
  }
  return motions;
}

void check_held(const ShellMesh& mesh, const ShellFreedom& freedom,
                const std::vector<GroundSpring>& springs) {
  const std::map<int, Mat3> pulls = sprung(springs);
  for (const Piece& piece : pieces_of(mesh, freedom)) {
    const Eigen::MatrixXd left = motions_left(mesh, freedom, piece, pulls);
    if (left.cols() > 0) {
      throw SolverError(fmt::format(
          "a shell of {} nodes around ({:.6g}, {:.6g}, {:.6g}) is free to {}; "
          "hold more of it",
          piece.nodes.size(), piece.center[0], piece.center[1], piece.center[2],
          motion_text(left.col(0))));
    }
  }
}

}  // namespace meniscus::shell
