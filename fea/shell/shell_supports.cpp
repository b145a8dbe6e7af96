#include "fea/shell/shell_supports.h"

#include <cstddef>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::shell {

ShellFreedom::ShellFreedom(int nodes, const std::vector<NodeSupport>& supports)
    : held_at_(nodes, -1) {
  for (const NodeSupport& support : supports) {
    if (support.node < 0 || support.node >= nodes) {
      throw InvalidInput(fmt::format("a support holds node {} of a shell of {}",
                                     support.node, nodes));
    }
    Held given{support.held, Mat3::Identity(), support.value};
    if (support.axes) {
      if (!element::span_a_plane(*support.axes)) {
        throw InvalidInput(fmt::format(
            "the axes of a support at node {} span no plane", support.node));
      }
      given.axes = element::unit_axes(*support.axes);
    }
    int& at = held_at_[support.node];
    if (at < 0) {
      at = static_cast<int>(held_.size());
      held_.push_back(given);
      continue;
    }
    Held& before = held_[at];
    if (before.axes != given.axes) {
      throw InvalidInput(fmt::format(
          "two supports hold node {} of a shell along different axes",
          support.node));
    }
    for (int k = 0; k < 6; ++k) {
      if (before.held[k] && given.held[k] &&
          before.value[k] != given.value[k]) {
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
  number_unknowns();
}

ShellFreedom ShellFreedom::of(const std::vector<int>& nodes) const {
  ShellFreedom part;
  for (const int node : nodes) {
    part.held_at_.push_back(held_at_[node]);
  }
  part.held_ = held_;
  part.number_unknowns();
  return part;
}

void ShellFreedom::number_unknowns() {
  start_.assign(1, 0);
  for (const int held : held_at_) {
    int count = 6;
    if (held >= 0) {
      for (const bool is_held : held_[held].held) {
        count -= is_held ? 1 : 0;
      }
    }
    start_.push_back(start_.back() + count);
  }
}

Eigen::Matrix<double, 6, Eigen::Dynamic> ShellFreedom::basis(int node) const {
  using Basis = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  if (is_plain(node)) {
    return Basis::Identity(6, 6);
  }
  const Held& held = held_[held_at_[node]];
  Basis Q = Basis::Zero(6, free_count(node));
  int column = 0;
  for (int k = 0; k < 6; ++k) {
    if (!held.held[k]) {
      Q.block<3, 1>(k < 3 ? 0 : 3, column++) = held.axes.col(k % 3);
    }
  }
  return Q;
}

VectorX ShellFreedom::held_values() const {
  VectorX u = VectorX::Zero(6L * nodes());
  for (int i = 0; i < nodes(); ++i) {
    if (is_plain(i)) {
      continue;
    }
    const Held& held = held_[held_at_[i]];
    for (int k = 0; k < 6; ++k) {
      if (held.held[k]) {
        u.segment<3>(6L * i + (k < 3 ? 0 : 3)) +=
            held.value[k] * held.axes.col(k % 3);
      }
    }
  }
  return u;
}

VectorX ShellFreedom::expand(const VectorX& q) const {
  VectorX u = held_values();
  for (int i = 0; i < nodes(); ++i) {
    u.segment<6>(6L * i) +=
        basis(i) * q.segment(first_unknown(i), free_count(i));
  }
  return u;
}

VectorX ShellFreedom::restrict(const VectorX& nodal) const {
  VectorX f(unknowns());
  for (int i = 0; i < nodes(); ++i) {
    f.segment(first_unknown(i), free_count(i)) =
        basis(i).transpose() * nodal.segment<6>(6L * i);
  }
  return f;
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
