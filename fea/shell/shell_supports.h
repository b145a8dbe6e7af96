/// What holds a shell's nodes, or moves them together, and which numbers of
/// them are free.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/math/dense.h"
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

/// Nodes that move as one rigid body, their rotations too: at d from its point
/// u = U + W x d and theta = W. It moves freely but for what is held.
struct RigidRim {
  std::string name;             // for messages
  std::vector<int> nodes = {};  // of no other rim
  Points places = {};           // theirs, one each [length]
  Vec3 point = Vec3::Zero();    // [length]
  /// Of U 1 2 3 and W 1 2 3, along and about x y z or the axes.
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

/// A node's numbers along its own axes; the free ones are unknowns. Those of
/// nodes on a rigid rim are the rim's: unknowns have their seat at a node or,
/// numbered after all nodes, at a rim.
class ShellFreedom {
 public:
  /// A node may be named again with the same axes: what is held adds up. Throws
  /// InvalidInput, naming the node, for one out of range, axes that span no
  /// plane, other axes than before, two values for one component, a node of two
  /// rims, and one of a rim that is held otherwise than the rim moves.
  ShellFreedom(int nodes, const std::vector<NodeSupport>& supports,
               const std::vector<RigidRim>& rims = {});

  /// The same of some seats alone, in this order, as if they were nodes.
  ShellFreedom of(const std::vector<int>& seats) const;

  int nodes() const { return nodes_; }
  int seats() const { return static_cast<int>(start_.size()) - 1; }
  int unknowns() const { return start_.back(); }
  const std::vector<RigidRim>& rims() const { return rims_; }
  /// Where the node's unknowns are: itself, or its rim.
  int seat(int node) const { return seat_.empty() ? node : seat_[node]; }
  /// The node's numbers by those of its seat; the identity but on rims.
  Matrix6 by_seat(int node) const;

  // Of a seat; a node on a rim has none.
  int first_unknown(int seat) const { return start_[seat]; }
  int free_count(int seat) const { return start_[seat + 1] - start_[seat]; }
  /// Six rows, a column per free component: orthonormal.
  Eigen::Matrix<double, 6, Eigen::Dynamic> basis(int seat) const;
  bool is_plain(int seat) const { return held_at_[seat] < 0; }

  /// 6 numbers per node, from unknowns; held ones are 0 or their values.
  VectorX expand(const VectorX& unknowns) const;
  VectorX held_values() const;
  /// Transposed: forces on unknowns from 6 per node.
  VectorX restrict(const VectorX& nodal) const;
  /// The unknowns of a motion that nodes can make, 6 per node.
  VectorX unknowns_of(const VectorX& nodal) const;

 private:
  struct Held {
    std::array<bool, 6> held = {};
    Mat3 axes = Mat3::Identity();
    Six value = Six::Zero();
  };
  ShellFreedom() = default;
  void hold(const NodeSupport& support);
  void take_rims();
  void require_met(const NodeSupport& support) const;
  void number_unknowns();
  Six held_value(int seat) const;
  VectorX to_nodes(const std::vector<Six>& of_seats) const;

  int nodes_ = 0;
  std::vector<RigidRim> rims_;
  std::vector<int> seat_;     // per node; empty without rims
  Points arm_;                // per node of a rim, from its point; or empty
  std::vector<int> start_;    // seats + 1
  std::vector<int> held_at_;  // per seat: index into held_, or -1
  std::vector<Held> held_;
};

}  // namespace meniscus::shell
