/// Work of a point's resultants on strains of second order (docs/theory.md,
/// Shells), for any kind of number as facet_strain.h: the same as
/// facet_geometric() has in its rows.
#pragma once

#include <array>

#include "fea/shell/facet_resultants.h"

namespace meniscus::shell {

/// x^T K_g x per area of the surface, x the field.
template <class T>
T second_work(const FacetPoint& p, const FacetFrame<T>& frame,
              const FacetResultants<T>& r, const FacetField& x) {
  const auto triple = [](const Vec3& v) -> Triple<double> {
    return {v[0], v[1], v[2]};
  };
  const Eigen::Matrix<double, 6, 2> by_coordinate =
      x * p.slope.topRows<kNodes>();
  Vec3 theta = Vec3::Zero();
  Vec3 metric = Vec3::Zero();  // 11, 12, 22 of du . du
  for (int i = 0; i < kNodes; ++i) {
    theta += p.shape[i] * x.col(i).tail<3>();
    for (int j = 0; j < kNodes; ++j) {
      metric += x.col(i).head<3>().dot(x.col(j).head<3>()) *
                p.stretched.block<3, 1>(3 * i, j);
    }
  }
  const auto& g = frame.by_axis;
  const auto& t = frame.axes;
  const auto along = [&](int a, int first) {
    return plus(times(g[a][0], triple(by_coordinate.col(0).segment<3>(first))),
                g[a][1], triple(by_coordinate.col(1).segment<3>(first)));
  };
  const Triple<double> turn = triple(theta);
  const Triple<T> d = cross(turn, t[2]);  // theta x n
  const Triple<T> w = cross(turn, d);     // twice the second turn
  std::array<Triple<T>, 2> u;             // derivatives along the axes
  std::array<Triple<T>, 2> slope_of_n;
  std::array<Triple<T>, 2> slope_of_d;
  std::array<Triple<T>, 2> slope_of_w;
  for (int a = 0; a < 2; ++a) {
    u[a] = along(a, 0);
    const Triple<T> turning = along(a, 3);
    slope_of_n[a] =
        plus(times(frame.curvature[a][0], t[0]), frame.curvature[a][1], t[1]);
    slope_of_d[a] = plus(cross(turning, t[2]), 1.0, cross(turn, slope_of_n[a]));
    slope_of_w[a] = plus(cross(turning, d), 1.0, cross(turn, slope_of_d[a]));
  }
  T sum = -dot(w, r.lever);
  for (int a = 0; a < 2; ++a) {
    sum = sum + r.shear[a] * (2.0 * dot(u[a], d) + dot(t[a], w));
    for (int b = 0; b < 2; ++b) {
      const T stretch = g[a][0] * g[b][0] * metric[0] +
                        (g[a][0] * g[b][1] + g[a][1] * g[b][0]) * metric[1] +
                        g[a][1] * g[b][1] * metric[2];
      sum = sum + r.stress[0][a][b] * stretch +
            r.stress[1][a][b] *
                (2.0 * dot(u[a], slope_of_d[b]) + dot(slope_of_w[a], t[b])) +
            r.stress[2][a][b] * (dot(slope_of_d[a], slope_of_d[b]) +
                                 dot(slope_of_w[a], slope_of_n[b]));
    }
  }
  return sum +
         2.0 * r.drilling *
             (dot(u[1], cross(t[0], turn)) - dot(u[0], cross(t[1], turn)));
}

}  // namespace meniscus::shell
