/// The ruled surface between two closed curves, or between two opposite sides
/// of one: straight lines from each point of one to its partner on the other.
#pragma once

#include <vector>

#include "evolve/curves/curve.h"

namespace meniscus::films {

/// Shares of a curve's length by its parameter, both rising from 0 to 1 and
/// linear between; empty: the share is the parameter.
struct LengthShares {
  std::vector<double> t;
  std::vector<double> share;
};

/// The point at parameter t of the outer curve has its partner on the inner one
/// where the share of its length is turn x share(t) + shift, in whole turns.
/// Fixed numbers: when the curves move, partners stay partners.
struct RuledBand {
  int outer = -1;  // indices into the complex's curves
  int inner = -1;
  double turn = 1.0;   // -1: the curves run against each other
  double shift = 0.0;  // in [0, 1)
  LengthShares outer_shares;
  LengthShares inner_shares;
  /// Of the outer curve: lines from t = 0 to here. Below 1 the band is a patch,
  /// open at both ends.
  double span = 1.0;

  bool is_patch() const { return span < 1.0; }

  double partner_of_outer(double t) const;  // on the inner curve, in [0, 1)
  double partner_of_inner(double t) const;  // on the outer curve, in [0, 1)
};

/// The band whose lines are shortest in the mean square. Curves of one kind
/// with as many parts are joined at equal parameters, part to part, others at
/// equal shares of their lengths; where the parts meet without corners, by
/// whichever is shorter. Closed curves only.
RuledBand match_band(const std::vector<curves::Curve>& curves, int outer,
                     int inner);

/// Shifts the band so that the points at these parameters are partners.
void make_partners(RuledBand& band, double outer_t, double inner_t);

/// Between the first and the third of a curve's four sides, equal parameters
/// joined. Throws InvalidInput, naming it, for a curve of other sides.
RuledBand match_patch(const std::vector<curves::Curve>& curves, int curve);

/// At parameter t of the outer curve, `share` of the way to the inner one.
Vec3 point_on_band(const RuledBand& band,
                   const std::vector<curves::Curve>& curves, double t,
                   double share);

struct BandPlace {
  double t = 0.0;      // of the outer curve, in [0, 1)
  double share = 0.0;  // of the way to the inner one, in [0, 1]
};

/// The place of the point at parameter `t` of a patch's own curve.
BandPlace place_on_patch(const RuledBand& patch, double t);

/// The place on the band nearest to `at`.
BandPlace nearest_on_band(const RuledBand& band,
                          const std::vector<curves::Curve>& curves,
                          const Vec3& at);

/// Halfway between two places, the shorter way around.
BandPlace middle_on_band(const BandPlace& a, const BandPlace& b);

}  // namespace meniscus::films
