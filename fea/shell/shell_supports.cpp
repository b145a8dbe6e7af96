#include "fea/shell/shell_supports.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "fea/shell/shell_held.h"

namespace meniscus::shell {

namespace {

constexpr double kMet = 1e-9;  // of rounding

Mat3 axes_of(const std::optional<element::LocalAxes>& axes,
             const std::string& whose) {
  if (!axes) {
    return Mat3::Identity();
  }
  if (!element::span_a_plane(*axes)) {
    throw InvalidInput(fmt::format("the axes of {} span no plane", whose));
  }
  return element::unit_axes(*axes);
}

std::string text_of(const Vec3& x) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", x.x(), x.y(), x.z());
}

}  // namespace

ShellFreedom::ShellFreedom(int nodes, const std::vector<NodeSupport>& supports,
                           const std::vector<RigidRim>& rims)
    : nodes_(nodes), rims_(rims), held_at_(nodes, -1) {
  take_rims();
  for (const NodeSupport& support : supports) {
    if (support.node < 0 || support.node >= nodes) {
      throw InvalidInput(fmt::format("a support holds node {} of a shell of {}",
                                     support.node, nodes));
    }
    if (seat(support.node) == support.node) {
      hold(support);
    } else {
      require_met(support);
    }
  }
  number_unknowns();
}

void ShellFreedom::hold(const NodeSupport& support) {
  const Held given{
      support.held,
      axes_of(support.axes, fmt::format("a support at node {}", support.node)),
      support.value};
  int& at = held_at_[support.node];
  if (at < 0) {
    at = static_cast<int>(held_.size());
    held_.push_back(given);
    return;
  }
  Held& before = held_[at];
  if (before.axes != given.axes) {
    throw InvalidInput(
        fmt::format("two supports hold node {} of a shell along different axes",
                    support.node));
  }
  for (int k = 0; k < 6; ++k) {
    if (before.held[k] && given.held[k] && before.value[k] != given.value[k]) {
      throw InvalidInput(fmt::format(
          "two supports hold component {} of node {} at {} and at {}", k + 1,
          support.node, before.value[k], given.value[k]));
    }
    if (given.held[k]) {
      before.held[k] = true;
      before.value[k] = given.value[k];
    }
  }
}

void ShellFreedom::take_rims() {
  if (rims_.empty()) {
    return;
  }
  seat_.resize(nodes_);
  std::iota(seat_.begin(), seat_.end(), 0);
  arm_.assign(nodes_, Vec3::Zero());
  for (std::size_t r = 0; r < rims_.size(); ++r) {
    const RigidRim& rim = rims_[r];
    const std::string whose = fmt::format("the rigid '{}'", rim.name);
    if (rim.nodes.empty() || rim.nodes.size() != rim.places.size() ||
        !rim.point.allFinite() || !rim.value.allFinite()) {
      throw InvalidInput(fmt::format(
          "{} has {} nodes, {} places and a point or values that may not be "
          "finite",
          whose, rim.nodes.size(), rim.places.size()));
    }
    for (std::size_t i = 0; i < rim.nodes.size(); ++i) {
      const int node = rim.nodes[i];
      if (node < 0 || node >= nodes_) {
        throw InvalidInput(fmt::format("{} has node {} of a shell of {}", whose,
                                       node, nodes_));
      }
      if (seat_[node] >= nodes_) {
        throw InvalidInput(fmt::format(
            "the node at {} is on {} and on the rigid '{}'; name both in one "
            "entry",
            text_of(rim.places[i]), whose, rims_[seat_[node] - nodes_].name));
      }
      seat_[node] = nodes_ + static_cast<int>(r);
      arm_[node] = rim.places[i] - rim.point;
    }
    held_at_.push_back(static_cast<int>(held_.size()));
    held_.push_back({rim.held, axes_of(rim.axes, whose), rim.value});
  }
}

/// A rim holds its nodes by itself: what a support adds must be met by all its
/// motions.
void ShellFreedom::require_met(const NodeSupport& support) const {
  const int node = support.node;
  const RigidRim& rim = rims_[seat_[node] - nodes_];
  const Mat3 axes =
      axes_of(support.axes, fmt::format("a support at node {}", node));
  const Matrix6 T = by_seat(node);
  const Eigen::Matrix<double, 6, Eigen::Dynamic> free = T * basis(seat(node));
  const Six value = T * held_value(seat(node));
  const double size = arm_[node].norm();
  for (int k = 0; k < 6; ++k) {
    if (!support.held[k]) {
      continue;
    }
    const Eigen::Index first = k < 3 ? 0 : 3;
    const Vec3 along = axes.col(k % 3);
    const double moves = (along.transpose() * free.middleRows<3>(first)).norm();
    const double off =
        std::abs(along.dot(value.segment<3>(first)) - support.value[k]);
    const double all =
        std::max(value.norm() * (1.0 + size), std::abs(support.value[k]));
    if (moves > kMet * (1.0 + (k < 3 ? size : 0.0)) || off > kMet * all) {
      throw InvalidInput(fmt::format(
          "the node at {} is on the rigid '{}' and held by a support otherwise "
          "than that moves; fix the rigid one along with it (fix, "
          "fix_rotation), or end one of them before the node",
          text_of(rim.point + arm_[node]), rim.name));
    }
  }
}

ShellFreedom ShellFreedom::of(const std::vector<int>& seats) const {
  ShellFreedom part;
  part.nodes_ = static_cast<int>(seats.size());
  for (const int seat : seats) {
    part.held_at_.push_back(held_at_[seat]);
  }
  part.held_ = held_;
  part.number_unknowns();
  return part;
}

void ShellFreedom::number_unknowns() {
  start_.assign(1, 0);
  for (std::size_t k = 0; k < held_at_.size(); ++k) {
    const auto own = static_cast<int>(k);
    int count = own < nodes_ && seat(own) != own ? 0 : 6;
    if (const int held = held_at_[k]; held >= 0) {
      for (const bool is_held : held_[held].held) {
        count -= is_held ? 1 : 0;
      }
    }
    start_.push_back(start_.back() + count);
  }
}

Matrix6 ShellFreedom::by_seat(int node) const {
  return seat(node) == node ? Matrix6(Matrix6::Identity())
                            : rigid_motions(arm_[node], 1.0);
}

Eigen::Matrix<double, 6, Eigen::Dynamic> ShellFreedom::basis(int seat) const {
  using Basis = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  if (is_plain(seat)) {
    return Basis::Identity(6, 6);
  }
  const Held& held = held_[held_at_[seat]];
  Basis Q =
      Basis::Zero(6, std::count(held.held.begin(), held.held.end(), false));
  int column = 0;
  for (int k = 0; k < 6; ++k) {
    if (!held.held[k]) {
      Q.block<3, 1>(k < 3 ? 0 : 3, column++) = held.axes.col(k % 3);
    }
  }
  return Q;
}

Six ShellFreedom::held_value(int seat) const {
  Six value = Six::Zero();
  if (!is_plain(seat)) {
    const Held& held = held_[held_at_[seat]];
    for (int k = 0; k < 6; ++k) {
      if (held.held[k]) {
        value.segment<3>(k < 3 ? 0 : 3) += held.value[k] * held.axes.col(k % 3);
      }
    }
  }
  return value;
}

VectorX ShellFreedom::to_nodes(const std::vector<Six>& of_seats) const {
  VectorX u(6L * nodes_);
  for (int i = 0; i < nodes_; ++i) {
    const int own = seat(i);
    u.segment<6>(6L * i) =
        own == i ? of_seats[own] : Six(by_seat(i) * of_seats[own]);
  }
  return u;
}

VectorX ShellFreedom::held_values() const {
  std::vector<Six> values;
  values.reserve(seats());
  for (int k = 0; k < seats(); ++k) {
    values.push_back(held_value(k));
  }
  return to_nodes(values);
}

VectorX ShellFreedom::expand(const VectorX& q) const {
  std::vector<Six> values;
  values.reserve(seats());
  for (int k = 0; k < seats(); ++k) {
    Six& value = values.emplace_back(held_value(k));
    if (free_count(k) > 0) {
      value += basis(k) * q.segment(first_unknown(k), free_count(k));
    }
  }
  return to_nodes(values);
}

VectorX ShellFreedom::restrict(const VectorX& nodal) const {
  std::vector<Six> forces(seats(), Six::Zero());
  for (int i = 0; i < nodes_; ++i) {
    const Six own = nodal.segment<6>(6L * i);
    forces[seat(i)] += seat(i) == i ? own : Six(by_seat(i).transpose() * own);
  }
  VectorX f(unknowns());
  for (int k = 0; k < seats(); ++k) {
    if (free_count(k) > 0) {
      f.segment(first_unknown(k), free_count(k)) =
          basis(k).transpose() * forces[k];
    }
  }
  return f;
}

VectorX ShellFreedom::unknowns_of(const VectorX& nodal) const {
  VectorX q(unknowns());
  for (int k = 0; k < seats(); ++k) {
    const int node = k < nodes_ ? k : rims_[k - nodes_].nodes.front();
    Six motion = nodal.segment<6>(6L * node);
    if (k >= nodes_) {
      const Vec3 turn = motion.tail<3>();
      motion.head<3>() -= turn.cross(arm_[node]);
    }
    if (free_count(k) > 0) {
      q.segment(first_unknown(k), free_count(k)) =
          basis(k).transpose() * motion;
    }
  }
  return q;
}

VectorX displacements_of(const VectorX& six) {
  VectorX three(six.size() / 2);
  for (Eigen::Index i = 0; i < three.size() / 3; ++i) {
    three.segment<3>(3 * i) = six.segment<3>(6 * i);
  }
  return three;
}

VectorX rotations_of(const VectorX& six) {
  VectorX three(six.size() / 2);
  for (Eigen::Index i = 0; i < three.size() / 3; ++i) {
    three.segment<3>(3 * i) = six.segment<3>(6 * i + 3);
  }
  return three;
}

VectorX with_rotations(const VectorX& three) {
  VectorX six = VectorX::Zero(2 * three.size());
  for (Eigen::Index i = 0; i < three.size() / 3; ++i) {
    six.segment<3>(6 * i) = three.segment<3>(3 * i);
  }
  return six;
}

}  // namespace meniscus::shell
