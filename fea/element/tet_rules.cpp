#include "fea/element/tet_rules.h"

#include "fea/element/tet_shape.h"

namespace meniscus::element {

namespace {

template <int Nodes>
typename TetRule<Nodes>::Point rule_point_at(const Barycentric& L,
                                             double weight) {
  typename TetRule<Nodes>::Point point;
  const std::array<Vec3, Nodes> slopes = tet_slopes_at<Nodes>(L);
  for (int a = 0; a < Nodes; ++a) {
    point.slopes.row(a) = slopes[a];
  }
  point.shape = tet_shapes<Nodes>(L);
  point.weight = weight;
  return point;
}

constexpr double kReferenceVolume = 1.0 / 6.0;

template <int Nodes>
TetRule<Nodes> make_stiffness_rule() {
  TetRule<Nodes> rule;
  for (int q = 0; q < kTetPoints<Nodes>; ++q) {
    rule.points.push_back(rule_point_at<Nodes>(
        rule_point<Nodes>(q), kReferenceVolume / kTetPoints<Nodes>));
  }
  return rule;
}

/// Of degree 3, as quadratic_volume(); a straight element's centre will do.
template <int Nodes>
TetRule<Nodes> make_volume_rule() {
  if (Nodes == 4) {
    return make_stiffness_rule<Nodes>();
  }
  TetRule<Nodes> rule;
  rule.points.push_back(rule_point_at<Nodes>({0.25, 0.25, 0.25, 0.25},
                                             -4.0 / 5.0 * kReferenceVolume));
  for (int q = 0; q < 4; ++q) {
    Barycentric L;
    L.fill(1.0 / 6.0);
    L[q] = 0.5;
    rule.points.push_back(
        rule_point_at<Nodes>(L, 9.0 / 20.0 * kReferenceVolume));
  }
  return rule;
}

template <int Nodes>
TetRule<Nodes> make_degree_five_rule() {
  TetRule<Nodes> rule;
  for (const TetRulePoint& point : fine_tet_rule()) {
    rule.points.push_back(
        rule_point_at<Nodes>(point.L, point.weight * kReferenceVolume));
  }
  return rule;
}

/// Ten-node elements' stiffness rule is of degree two.
TetRule<4> make_mass_rule() {
  TetRule<4> rule;
  for (int q = 0; q < kTetPoints<10>; ++q) {
    rule.points.push_back(
        rule_point_at<4>(rule_point<10>(q), kReferenceVolume / kTetPoints<10>));
  }
  return rule;
}

}  // namespace

template <int Nodes>
const TetRule<Nodes>& stiffness_rule() {
  static const TetRule<Nodes> kRule = make_stiffness_rule<Nodes>();
  return kRule;
}

template <int Nodes>
const TetRule<Nodes>& volume_rule() {
  static const TetRule<Nodes> kRule = make_volume_rule<Nodes>();
  return kRule;
}

template <int Nodes>
const TetRule<Nodes>& fine_rule() {
  static const TetRule<Nodes> kRule = make_degree_five_rule<Nodes>();
  return kRule;
}

template <int Nodes>
const TetRule<Nodes>& moment_rule() {
  return Nodes == 4 ? stiffness_rule<Nodes>() : fine_rule<Nodes>();
}

template <int Nodes>
const TetRule<Nodes>& mass_rule() {
  if constexpr (Nodes == 4) {
    static const TetRule<4> kRule = make_mass_rule();
    return kRule;
  } else {
    return moment_rule<Nodes>();
  }
}

template const TetRule<4>& stiffness_rule<4>();
template const TetRule<10>& stiffness_rule<10>();
template const TetRule<4>& volume_rule<4>();
template const TetRule<10>& volume_rule<10>();
template const TetRule<4>& fine_rule<4>();
template const TetRule<10>& fine_rule<10>();
template const TetRule<4>& moment_rule<4>();
template const TetRule<10>& moment_rule<10>();
template const TetRule<4>& mass_rule<4>();
template const TetRule<10>& mass_rule<10>();

}  // namespace meniscus::element
