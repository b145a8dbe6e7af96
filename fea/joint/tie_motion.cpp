#include "fea/joint/tie_motion.h"

#include <map>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace meniscus::joint {

namespace {

Mat3 cross_matrix(const Vec3& a) {
  Mat3 S;
  S << 0.0, -a[2], a[1], a[2], 0.0, -a[0], -a[1], a[0], 0.0;
  return S;
}

template <class Value>
Vec3 at_point(const TiePoint& point, const Value& value) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    sum += point.shape[k] * value(point.nodes[k]);
  }
  return sum;
}

/// Places of a fibre's points from their mean.
struct FibreArms {
  Vec3 mean = Vec3::Zero();
  Points arms;
};

FibreArms arms_of(const Fibre& fibre, const Points& solid) {
  FibreArms result;
  for (const TiePoint& point : fibre) {
    result.arms.push_back(
        at_point(point, [&](int node) -> const Vec3& { return solid[node]; }));
    result.mean += point.weight * result.arms.back();
  }
  for (Vec3& arm : result.arms) {
    arm -= result.mean;
  }
  return result;
}

/// What the fibres of a node are together.
struct NodeArms {
  std::vector<FibreArms> fibres;  // as the node's
  Mat3 square = Mat3::Zero();     // mean_arms()
  Vec3 arm = Vec3::Zero();        // to the node from the fibres' mean
  Mat3 turn = Mat3::Zero();       // rotation by the mean of arm x displacement
};

NodeArms arms_of(const EdgeTie& tie, const TiedNode& node,
                 const Points& solid) {
  NodeArms result;
  for (const FibreShare& own : node.fibres) {
    const Fibre& fibre = tie.fibres[own.fibre];
    FibreArms arms = arms_of(fibre, solid);
    for (std::size_t k = 0; k < fibre.size(); ++k) {
      const Vec3& r = arms.arms[k];
      result.square += own.share * fibre[k].weight *
                       (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    }
    result.arm -= own.share * arms.mean;
    result.fibres.push_back(std::move(arms));
  }
  return result;
}

NodeArms arms_of(const EdgeTie& tie, const TiedNode& node, const Points& solid,
                 const Points& shell) {
  NodeArms result = arms_of(tie, node, solid);
  result.arm += shell[node.node];
  const auto E = node.axes.leftCols<2>();
  const Eigen::Matrix2d B = E.transpose() * result.square * E;
  result.turn = E * B.inverse() * E.transpose();
  return result;
}

}  // namespace

Mat3 mean_arms(const EdgeTie& tie, const TiedNode& node, const Points& solid) {
  return arms_of(tie, node, solid).square;
}

std::vector<TieRow> tie_rows(const EdgeTie& tie, const Points& solid,
                             const Points& shell) {
  std::vector<TieRow> rows;
  rows.reserve(tie.nodes.size());
  for (const TiedNode& node : tie.nodes) {
    const NodeArms all = arms_of(tie, node, solid, shell);
    const Mat3 across = cross_matrix(all.arm);
    TieRow row{.node = node.node};
    const Vec3 axis = node.axes.col(2);
    const Vec3 own = axis - all.turn * all.square * axis;
    row.by_turn << own.cross(all.arm), own;
    std::map<int, Eigen::Matrix<double, 6, 3>> by;
    for (std::size_t f = 0; f < node.fibres.size(); ++f) {
      const Fibre& fibre = tie.fibres[node.fibres[f].fibre];
      for (std::size_t k = 0; k < fibre.size(); ++k) {
        const double weight = node.fibres[f].share * fibre[k].weight;
        const Mat3 turn = all.turn * cross_matrix(all.fibres[f].arms[k]);
        Eigen::Matrix<double, 6, 3> by_point;
        by_point << weight * (Mat3::Identity() - across * turn), weight * turn;
        for (std::size_t n = 0; n < fibre[k].nodes.size(); ++n) {
          by.try_emplace(fibre[k].nodes[n], Eigen::Matrix<double, 6, 3>::Zero())
              .first->second += fibre[k].shape[n] * by_point;
        }
      }
    }
    for (const auto& [id, matrix] : by) {
      row.solid.push_back(id);
      row.by_solid.push_back(matrix);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void add_tie_gradient(const EdgeTie& tie, const Points& solid,
                      const Points& shell, const VectorX& solid_motion,
                      const VectorX& shell_motion, const VectorX& forces,
                      Points& by_solid, Points& by_shell) {
  for (const TiedNode& node : tie.nodes) {
    const NodeArms all = arms_of(tie, node, solid, shell);
    const Vec3 force = forces.segment<3>(6L * node.node);
    const Vec3 moment = forces.segment<3>(6L * node.node + 3);
    const Vec3 theta = shell_motion.segment<3>(6L * node.node + 3);
    const Vec3 mu = all.turn * (moment + all.arm.cross(force));
    const Vec3 by_arm = force.cross(theta);
    by_shell[node.node] += by_arm;
    for (std::size_t f = 0; f < node.fibres.size(); ++f) {
      const double share = node.fibres[f].share;
      const Fibre& fibre = tie.fibres[node.fibres[f].fibre];
      Points by;
      Vec3 sum = Vec3::Zero();
      for (std::size_t k = 0; k < fibre.size(); ++k) {
        const Vec3& r = all.fibres[f].arms[k];
        const Vec3 u = at_point(fibre[k], [&](int id) -> Vec3 {
          return solid_motion.segment<3>(3L * id);
        });
        by.push_back(share * fibre[k].weight *
                     (u.cross(mu) - 2.0 * mu.dot(theta) * r +
                      r.dot(theta) * mu + r.dot(mu) * theta));
        sum += by.back();
      }
      for (std::size_t k = 0; k < fibre.size(); ++k) {
        const Vec3 by_point = by[k] - fibre[k].weight * (sum + share * by_arm);
        for (std::size_t n = 0; n < fibre[k].nodes.size(); ++n) {
          by_solid[fibre[k].nodes[n]] += fibre[k].shape[n] * by_point;
        }
      }
    }
  }
}

}  // namespace meniscus::joint
