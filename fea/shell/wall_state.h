/// What strains a wall freely: heat, and pressures on its faces.
#pragma once

#include <array>
#include <vector>

#include "core/types.h"
#include "fea/shell/facet_rule.h"
#include "fea/shell/laminate.h"

namespace meniscus::shell {

/// Linear between the wall's faces.
struct WallState {
  double temperature = 0.0;         // change at the middle of the wall
  double temperature_across = 0.0;  // at the positive face less the negative
  double stress_negative = 0.0;     // along the normal, at the faces
  double stress_positive = 0.0;     // [pressure]

  double heat(double at) const;  // `at` as LayerPoint has it
  double stress(double at) const;
  Vec3 free_strain(const PlyLaw& ply, double at) const;
};

/// A field on a facet, quadratic between its values at the nodes.
struct NodeValues {
  std::array<double, kNodes> value = {};
  /// Its gradient there, for derivatives only [value/length]; not a number
  /// where it has none.
  std::array<Vec3, kNodes> slope = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                                    Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};

  double at(const FacetPoint& p) const;
  NodeValues& operator+=(const NodeValues& more);
};

/// What varies over a facet beside what is the same everywhere.
struct FacetFields {
  NodeValues temperature;         // change
  NodeValues negative, positive;  // pressures on the two faces [pressure]
};

/// The state anywhere on a facet.
struct WallStates {
  WallState same;
  const FacetFields* fields = nullptr;  // not owned; may be null

  WallState at(const FacetPoint& p) const;
};

/// A value's derivatives by a facet's loads, by node: temperature, pressure on
/// the negative face and on the positive one, each along the facet's normal.
using ByLoads = Eigen::Matrix<double, 3, kNodes>;

/// Adds, at one place, what a value is by all three.
void add_by_loads(const FacetPoint& p, const Vec3& by, ByLoads& sum);

/// By force per mass: gravity, and MassForce's two.
struct ByMass {
  Vec3 gravity = Vec3::Zero();
  Vec3 at_origin = Vec3::Zero();
  Mat3 slope = Mat3::Zero();

  /// Of what a force per mass at x, of any kind, is multiplied by there.
  void add(const Vec3& factor, const Vec3& x);
  void add(double factor, const ByMass& more);
};

/// By all that strains walls or is by mass.
struct ActionGradient {
  std::vector<ByLoads> facets;
  ByMass mass;

  void add(double factor, const ActionGradient& more);
  void multiply(double factor);
};

/// A value's derivatives by the state at one place: the temperature, and the
/// stresses across the wall at the negative and the positive face.
struct StateGradient {
  Vec3 by = Vec3::Zero();

  /// Adds held . free_strain(ply, at) transposed, to the ply's numbers too.
  void add_free_strain(const WallState& state, const PlyLaw& ply, double at,
                       const Vec3& held, PlyLaw& by_ply);
  /// Adds `factor` times stress(at) transposed.
  void add_stress(double at, double factor);
  /// To the loads at the nodes.
  void add_to(const FacetPoint& p, ByLoads& sum) const;
};

}  // namespace meniscus::shell
