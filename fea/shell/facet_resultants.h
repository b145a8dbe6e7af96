/// What a facet's stresses, and loads that act off its surface, do at one point
/// on strains of second order, for any kind of number as facet_strain.h.
#pragma once

#include <array>

#include "fea/shell/facet_loads.h"
#include "fea/shell/facet_matrices.h"
#include "fea/shell/facet_strain.h"

namespace meniscus::shell {

/// Per area of the surface, along the frame's axes.
template <class T>
struct FacetResultants {
  /// Stress in the wall times powers 0, 1, 2 of the height, against strains of
  /// the surface's own coordinates; symmetric.
  std::array<Square<T>, 3> stress;
  std::array<T, 2> shear;  // across the wall
  T drilling;              // against stretch 12 less 21
  /// Pressures at the faces and weight, times the height they act at.
  Triple<T> lever;
};

/// All that resultants are of, on loan.
template <class T>
struct StressedPoint {
  const Facet& facet;
  const ShellLoads& loads;
  const FacetLoad& own;
  const FacetPoint& point;
  const FacetFrame<T>& frame;
  const FacetStrain<T>& strain;
  T thickness;
};

template <class T>
FacetResultants<T> facet_resultants(const StressedPoint<T>& at) {
  const LaminateLaw& law = *at.facet.law;
  const WallState state = wall_states(at.loads, at.own).at(at.point);
  const auto height = [&](double place) -> T {
    return (place + at.facet.offset) * at.thickness;
  };
  FacetResultants<T> sum{};
  T moment(0.0);  // of mass
  for (const LayerPoint& layer : law.points) {
    const PlyLaw& ply = law.plies[layer.ply];
    const T zeta = height(layer.at);
    const Square<T> shift = shifter(at.frame.curvature, zeta);
    const Square<T> back = inverse(shift);
    const T weight = layer.weight * at.thickness * determinant(shift);
    const LayerStrain<T> e = layer_strain(at.strain, back, zeta);
    const Vec3 free = state.free_strain(ply, layer.at);
    Triple<T> s{};  // 11, 22, 12
    std::array<T, 2> across{};
    for (int i = 0; i < 3; ++i) {
      s[i] = ply.plane(i, 0) * (e.plane[0] - free[0]) +
             ply.plane(i, 1) * (e.plane[1] - free[1]) +
             ply.plane(i, 2) * (e.plane[2] - free[2]);
    }
    for (int i = 0; i < 2; ++i) {
      across[i] =
          law.across(i, 0) * e.across[0] + law.across(i, 1) * e.across[1];
    }
    for (int a = 0; a < 2; ++a) {
      sum.shear[a] = sum.shear[a] +
                     weight * (back[0][a] * across[0] + back[1][a] * across[1]);
      for (int b = 0; b < 2; ++b) {
        const T here =
            weight * (back[0][a] * (s[0] * back[0][b] + s[2] * back[1][b]) +
                      back[1][a] * (s[2] * back[0][b] + s[1] * back[1][b]));
        sum.stress[0][a][b] = sum.stress[0][a][b] + here;
        sum.stress[1][a][b] = sum.stress[1][a][b] + zeta * here;
        sum.stress[2][a][b] = sum.stress[2][a][b] + zeta * zeta * here;
      }
    }
    moment = moment + ply.density * weight * zeta;
  }
  sum.drilling = kDrilling * law.mean_shear * at.thickness *
                 (at.strain.stretch[0][1] - at.strain.stretch[1][0]);
  const auto push = [&](double pressure, double place) -> T {
    const T zeta = height(place);
    return pressure * zeta * determinant(shifter(at.frame.curvature, zeta));
  };
  const FacePressures acting = pressures_at(at.own, at.point);
  const T pushed = push(acting.negative, -0.5) + push(acting.middle, 0.0) +
                   push(acting.positive, 0.5);
  const Vec3& g = at.loads.gravity;
  sum.lever = plus(times(moment, Triple<double>{g[0], g[1], g[2]}), pushed,
                   at.frame.axes[2]);
  return sum;
}

}  // namespace meniscus::shell
