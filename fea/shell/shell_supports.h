/// What holds a shell's nodes, and which numbers of them are free.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/types.h"
#include "fea/element/local_axes.h"

namespace meniscus::shell {

using Six = Eigen::Matrix<double, 6, 1>;

/// Displacements and rotations of 6 numbers per node, 3 each; and back, without
/// rotations.
VectorX displacements_of(const VectorX& six);
VectorX rotations_of(const VectorX& six);
VectorX with_rotations(const VectorX& three);

/// Holds components of a node: displacements 1 2 3, rotations about 1 2 3,
/// along x y z or the support's axes.
struct NodeSupport {
  int node = 0;
  std::array<bool, 6> held = {};
  std::optional<element::LocalAxes> axes = {};
  Six value = Six::Zero();  // what the held ones are held at [length], [rad]
};

/// Springs between the ground and nodes of one facet: where node `from` moves
/// by u, node `at` is pulled with -block u; the two are the same, or the
/// transposed block acts back.
struct GroundSpring {
  int at = 0;
  int from = 0;
  Mat3 block = Mat3::Zero();  // [force/length]
};

/// A node's numbers along its own axes; the free ones are unknowns.
class ShellFreedom {
 public:
  /// A node may be named again with the same axes: what is held adds up. Throws
  /// InvalidInput, naming the node, for one out of range, axes that span no
  /// plane, other axes than before, or two values for one component.
  ShellFreedom(int nodes, const std::vector<NodeSupport>& supports);

  /// The same of some nodes alone, in this order.
  ShellFreedom of(const std::vector<int>& nodes) const;

  int nodes() const { return static_cast<int>(start_.size()) - 1; }
  int unknowns() const { return start_.back(); }
  int first_unknown(int node) const { return start_[node]; }
  int free_count(int node) const { return start_[node + 1] - start_[node]; }
  /// Six rows, a column per free component: orthonormal.
  Eigen::Matrix<double, 6, Eigen::Dynamic> basis(int node) const;
  bool is_plain(int node) const { return held_at_[node] < 0; }

  /// 6 numbers per node, from unknowns; held ones are 0 or their values.
  VectorX expand(const VectorX& unknowns) const;
  VectorX held_values() const;
  /// Transposed: forces on unknowns from 6 per node.
  VectorX restrict(const VectorX& nodal) const;

 private:
  ShellFreedom() = default;
  void number_unknowns();

  struct Held {
    std::array<bool, 6> held = {};
    Mat3 axes = Mat3::Identity();
    Six value = Six::Zero();
  };
  std::vector<int> start_;    // nodes + 1
  std::vector<int> held_at_;  // per node: index into held_, or -1
  std::vector<Held> held_;
};

}  // namespace meniscus::shell
