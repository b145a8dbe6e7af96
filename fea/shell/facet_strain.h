/// Strains of a facet at one point, for any kind of number: doubles, or numbers
/// that carry derivatives (core/math/taped.h).
///
/// A point zeta above the surface X is X + zeta n and moves by u + zeta theta x
/// n. With the one-form G = du - theta x dX (Cosserat's stretch) its tangents
/// g_a = X,a + zeta n,a turn with theta and move further by
///   D_a = G_a + zeta theta,a x n,
/// so that sym(D_a . g_b) is the strain in the surface, G_a . n the shear
/// across it, and the skew part by how much theta about the normal differs from
/// the surface's own turn: no term is left out, at any zeta. Against locking
/// sym(G_a . X,b) = sym(u,a . X,b) is interpolated in Regge's space of degree
/// one (Neunteufel and Schoeberl, Comput. Methods Appl. Mech. Eng. 373, 2021),
/// theta x dX in Nedelec's of degree two, as in the plate element MITC7 (Bathe,
/// Brezzi, Cho, Comput. Struct. 32, 1989).
#pragma once

#include <array>
#include <cmath>

#include "core/types.h"
#include "fea/shell/facet_rule.h"
#include "fea/shell/laminate.h"

namespace meniscus::shell {

template <class T>
using Triple = std::array<T, 3>;

template <class T, class U>
auto dot(const Triple<T>& a, const Triple<U>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T, class U>
auto cross(const Triple<T>& a, const Triple<U>& b)
    -> Triple<decltype(a[0] * b[0])> {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0]};
}
/// a + s b.
template <class T, class U, class V>
auto plus(const Triple<T>& a, const U& s, const Triple<V>& b)
    -> Triple<decltype(a[0] + s * b[0])> {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
template <class T, class U>
auto times(const U& s, const Triple<T>& a) -> Triple<decltype(s * a[0])> {
  return {s * a[0], s * a[1], s * a[2]};
}

inline Vec3 as_vector(const Triple<double>& a) { return {a[0], a[1], a[2]}; }

template <class T>
using Square = std::array<std::array<T, 2>, 2>;

template <class T>
Square<T> inverse(const Square<T>& m) {
  const T r = 1.0 / (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
  return {{{r * m[1][1], -(r * m[0][1])}, {-(r * m[1][0]), r * m[0][0]}}};
}

/// The surface at a point.
template <class T>
struct FacetFrame {
  std::array<Triple<T>, 3> axes;  // 1, 2 in the surface, 3 its normal
  Square<T> by_axis;    // [i][a]: derivative along axis i of coordinate a
  Square<T> curvature;  // [i][j]: axis j of the normal's derivative along axis
                        // i: 1/R of a sphere whose normals point outwards
  T area;               // of the surface over the reference triangle's
};

template <class T>
FacetFrame<T> facet_frame(const std::array<Triple<T>, kNodes>& X,
                          const FacetPoint& p, const Vec3* direction) {
  std::array<Triple<T>, 2> a{};
  std::array<Triple<T>, 3> aa{};
  for (int j = 0; j < kNodes; ++j) {
    for (int k = 0; k < 2; ++k) {
      a[k] = plus(a[k], p.slope(j, k), X[j]);
    }
    for (int k = 0; k < 3; ++k) {
      aa[k] = plus(aa[k], p.curve(j, k), X[j]);
    }
  }
  using std::sqrt;
  FacetFrame<T> f;
  const Triple<T> N = cross(a[0], a[1]);
  f.area = sqrt(dot(N, N));
  const Triple<T> n = times(1.0 / f.area, N);
  Triple<T> first = a[0];
  if (direction != nullptr) {
    const Triple<double> d = {(*direction)[0], (*direction)[1],
                              (*direction)[2]};
    const Triple<T> along = {T(d[0]), T(d[1]), T(d[2])};
    first = plus(along, -dot(n, d), n);
  }
  const Triple<T> t1 = times(1.0 / sqrt(dot(first, first)), first);
  f.axes = {t1, cross(n, t1), n};
  Square<T> covariant;  // [a][i]
  Square<T> turning;    // [a][j]: n,a along axis j
  for (int k = 0; k < 2; ++k) {
    const Triple<T> slope = times(
        1.0 / f.area, plus(cross(aa[k], a[1]), 1.0, cross(a[0], aa[k + 1])));
    for (int i = 0; i < 2; ++i) {
      covariant[k][i] = dot(a[k], f.axes[i]);
      turning[k][i] = dot(slope, f.axes[i]);
    }
  }
  f.by_axis = inverse(covariant);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      f.curvature[i][j] =
          f.by_axis[i][0] * turning[0][j] + f.by_axis[i][1] * turning[1][j];
    }
  }
  return f;
}

/// Along a facet's edge: its conormal, out of the facet, times the length over
/// the reference coordinate's.
template <class T>
Triple<T> edge_conormal(const std::array<Triple<T>, kNodes>& X,
                        const EdgePoint& p) {
  const FacetFrame<T> frame = facet_frame(X, p.at, nullptr);
  Triple<T> tangent{};
  for (int j = 0; j < kNodes; ++j) {
    const double slope = p.at.slope.row(j).dot(p.along);
    tangent = plus(tangent, slope, X[j]);
  }
  return cross(tangent, frame.axes[2]);
}

/// Along the frame's axes: [i][j] is component j of the derivative along i.
template <class T>
struct FacetStrain {
  Square<T> stretch;       // of G [1]; symmetric but for the drilling
  Square<T> bend;          // of theta,a x n [1/length]
  std::array<T, 2> shear;  // of G along the normal
};

/// Columns: displacement and rotation of the six nodes.
using FacetField = Eigen::Matrix<double, 6, kNodes>;

/// `bubble`: the bubble's rotation. What is interpolated is linear in the
/// nodes' places, with the field's numbers as coefficients.
template <class T>
FacetStrain<T> facet_strain(const std::array<Triple<T>, kNodes>& X,
                            const FacetPoint& p, const FacetFrame<T>& frame,
                            const FacetField& field, const Triple<T>& bubble) {
  std::array<Triple<T>, 2> G{};
  std::array<Triple<T>, 2> turn{};
  std::array<T, 3> metric{};
  const auto triple = [](const Vec3& v) -> Triple<double> {
    return {v[0], v[1], v[2]};
  };
  for (int a = 0; a < 2; ++a) {
    Vec3 moved = field.topRows<3>() * p.slope.col(a).head<kNodes>();
    Vec3 turned = field.bottomRows<3>() * p.slope.col(a).head<kNodes>();
    Triple<T> carried{};
    for (int j = 0; j < kNodes; ++j) {
      Vec3 theta = Vec3::Zero();
      for (int i = 0; i < kNodes; ++i) {
        theta += p.carried(2 * i + a, j) * field.col(i).tail<3>();
      }
      G[a] = plus(G[a], 1.0, cross(X[j], triple(theta)));
      carried = plus(carried, p.carried(2 * kNodes + a, j), X[j]);
    }
    G[a] = plus(plus(G[a], 1.0, cross(carried, bubble)), 1.0, triple(moved));
    turn[a] = plus(times(p.slope(kNodes, a), bubble), 1.0, triple(turned));
  }
  for (int j = 0; j < kNodes; ++j) {
    for (int k = 0; k < 3; ++k) {
      Vec3 u = Vec3::Zero();
      for (int i = 0; i < kNodes; ++i) {
        u += p.stretched(3 * i + k, j) * field.col(i).head<3>();
      }
      metric[k] = metric[k] + dot(X[j], triple(u));
    }
  }
  FacetStrain<T> s;
  const auto& g = frame.by_axis;
  for (int i = 0; i < 2; ++i) {
    const auto along = [&](const std::array<Triple<T>, 2>& form) {
      return plus(times(g[i][0], form[0]), g[i][1], form[1]);
    };
    const Triple<T> stretch = along(G);
    const Triple<T> bend = cross(along(turn), frame.axes[2]);
    for (int j = 0; j < 2; ++j) {
      s.stretch[i][j] = dot(stretch, frame.axes[j]);
      s.bend[i][j] = dot(bend, frame.axes[j]);
    }
    s.shear[i] = dot(stretch, frame.axes[2]);
  }
  const T skew = 0.5 * (s.stretch[0][1] - s.stretch[1][0]);
  const auto symmetric = [&](int i, int j) {
    return g[i][0] * g[j][0] * metric[0] +
           (g[i][0] * g[j][1] + g[i][1] * g[j][0]) * metric[1] +
           g[i][1] * g[j][1] * metric[2];
  };
  s.stretch = {{{symmetric(0, 0), symmetric(0, 1) + skew},
                {symmetric(0, 1) - skew, symmetric(1, 1)}}};
  return s;
}

/// Strains at a height over the surface.
template <class T>
struct LayerStrain {
  Triple<T> plane;          // 11, 22, 12 (double)
  std::array<T, 2> across;  // 13, 23 (double)
};

/// 1 + zeta times the curvature: tangents there over those of the surface; its
/// determinant is the area there over the surface's.
template <class T>
Square<T> shifter(const Square<T>& curvature, const T& zeta) {
  return {{{1.0 + zeta * curvature[0][0], zeta * curvature[0][1]},
           {zeta * curvature[1][0], 1.0 + zeta * curvature[1][1]}}};
}

template <class T>
T determinant(const Square<T>& m) {
  return m[0][0] * m[1][1] - m[0][1] * m[1][0];
}

/// `by_tangent`: the shifter's inverse.
template <class T>
LayerStrain<T> layer_strain(const FacetStrain<T>& s,
                            const Square<T>& by_tangent, const T& zeta) {
  Square<T> D;
  LayerStrain<T> e;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      D[i][j] = by_tangent[i][0] * (s.stretch[0][j] + zeta * s.bend[0][j]) +
                by_tangent[i][1] * (s.stretch[1][j] + zeta * s.bend[1][j]);
    }
    e.across[i] = by_tangent[i][0] * s.shear[0] + by_tangent[i][1] * s.shear[1];
  }
  e.plane = {D[0][0], D[1][1], D[0][1] + D[1][0]};
  return e;
}

/// The two axes of the bubble's rotation: those of the facet's center.
template <class T>
std::array<Triple<T>, 2> bubble_axes(const std::array<Triple<T>, kNodes>& X) {
  const FacetFrame<T> frame = facet_frame(X, facet_center(), nullptr);
  return {frame.axes[0], frame.axes[1]};
}

/// A bubble's rotation by its two numbers.
template <class T>
Triple<T> bubble_turn(const std::array<Triple<T>, 2>& axes,
                      const Eigen::Vector2d& numbers) {
  return plus(times(numbers[0], axes[0]), numbers[1], axes[1]);
}

}  // namespace meniscus::shell
