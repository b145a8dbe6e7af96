#include "fea/shell/facet_rule.h"

#include <Eigen/LU>

#include "core/math/gauss_rule.h"
#include "core/types.h"

namespace meniscus::shell {

namespace {

using Moments = Eigen::Matrix<double, 8, 1>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;
using Form = Eigen::Vector2d;  // components of a one-form

constexpr double kCorner[3][2] = {{0, 0}, {1, 0}, {0, 1}};

struct Place {
  double xi, eta, weight;
};

/// A rule of the reference triangle by two Gauss rules, one squeezed into a
/// corner (Stroud's conical product): exact to degree six.
std::vector<Place> triangle_places() {
  constexpr int kPoints = 4;
  std::vector<Place> places;
  for (const GaussPoint& a : gauss_rule(kPoints)) {
    for (const GaussPoint& b : gauss_rule(kPoints)) {
      places.push_back(
          {a.at, b.at * (1.0 - a.at), a.weight * b.weight * (1.0 - a.at)});
    }
  }
  return places;
}

/// The space: linear forms, and those of degree two across the place.
Eigen::Matrix<double, 2, 8> monomials(double x, double y) {
  Eigen::Matrix<double, 2, 8> m;
  m << 1, 0, x, 0, y, 0, -x * y, -y * y,  //
      0, 1, 0, x, 0, y, x * x, x * y;
  return m;
}

/// Two moments along each edge, two inside.
template <class FormAt>
Moments moments_of(const FormAt& form) {
  Moments moments = Moments::Zero();
  for (int e = 0; e < 3; ++e) {
    const double* from = kCorner[e];
    const double* to = kCorner[(e + 1) % 3];
    const Form along(to[0] - from[0], to[1] - from[1]);
    for (const GaussPoint& g : gauss_rule(4)) {
      const double value =
          g.weight *
          along.dot(form(from[0] + g.at * along[0], from[1] + g.at * along[1]));
      moments[2 * e] += value;
      moments[2 * e + 1] += value * (2.0 * g.at - 1.0);
    }
  }
  for (const Place& p : triangle_places()) {
    moments.tail<2>() += p.weight * form(p.xi, p.eta);
  }
  return moments;
}

Matrix8 inverse_moments() {
  Matrix8 V;
  for (int k = 0; k < 8; ++k) {
    V.col(k) = moments_of(
        [&](double x, double y) -> Form { return monomials(x, y).col(k); });
  }
  return V.inverse();
}

using Moments9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Tensor = Eigen::Vector3d;  // 11, 12, 22

Eigen::Matrix<double, 3, 9> linear_tensors(double x, double y) {
  Eigen::Matrix<double, 3, 9> m;
  m << Mat3::Identity(), x * Mat3::Identity(), y * Mat3::Identity();
  return m;
}

template <class TensorAt>
Moments9 tensor_moments(const TensorAt& tensor) {
  Moments9 moments = Moments9::Zero();
  for (int e = 0; e < 3; ++e) {
    const double* from = kCorner[e];
    const double* to = kCorner[(e + 1) % 3];
    const Form along(to[0] - from[0], to[1] - from[1]);
    const Tensor twice(along[0] * along[0], 2.0 * along[0] * along[1],
                       along[1] * along[1]);
    for (const GaussPoint& g : gauss_rule(4)) {
      const double value =
          g.weight * twice.dot(tensor(from[0] + g.at * along[0],
                                      from[1] + g.at * along[1]));
      moments[2 * e] += value;
      moments[2 * e + 1] += value * (2.0 * g.at - 1.0);
    }
  }
  for (const Place& p : triangle_places()) {
    moments.tail<3>() += p.weight * tensor(p.xi, p.eta);
  }
  return moments;
}

struct StretchedForms {
  std::array<std::array<Moments9, kNodes>, kNodes> monomial;
};

StretchedForms stretched_forms() {
  Matrix9 V;
  for (int k = 0; k < 9; ++k) {
    V.col(k) = tensor_moments([&](double x, double y) -> Tensor {
      return linear_tensors(x, y).col(k);
    });
  }
  const Matrix9 solve = V.inverse();
  StretchedForms forms;
  for (int i = 0; i < kNodes; ++i) {
    for (int j = 0; j < kNodes; ++j) {
      forms.monomial[i][j] =
          solve * tensor_moments([&](double x, double y) -> Tensor {
            const FacetPoint p = facet_functions(x, y);
            const auto a = p.slope.row(i);
            const auto b = p.slope.row(j);
            return {a[0] * b[0], 0.5 * (a[0] * b[1] + a[1] * b[0]),
                    a[1] * b[1]};
          });
    }
  }
  return forms;
}

/// Coefficients of the interpolation of N_i dN_j.
struct CarriedForms {
  std::array<std::array<Moments, kNodes>, kFunctions> monomial;
};

CarriedForms carried_forms() {
  const Matrix8 solve = inverse_moments();
  CarriedForms forms;
  for (int i = 0; i < kFunctions; ++i) {
    for (int j = 0; j < kNodes; ++j) {
      forms.monomial[i][j] =
          solve * moments_of([&](double x, double y) -> Form {
            const FacetPoint p = facet_functions(x, y);
            return p.shape[i] * p.slope.row(j).transpose();
          });
    }
  }
  return forms;
}

}  // namespace

FacetPoint facet_functions(double xi, double eta) {
  FacetPoint p;
  const double L[3] = {1.0 - xi - eta, xi, eta};
  constexpr double kSlope[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
  for (int c = 0; c < 3; ++c) {
    const int d = (c + 1) % 3;
    p.shape[c] = L[c] * (2.0 * L[c] - 1.0);
    p.shape[3 + c] = 4.0 * L[c] * L[d];
    for (int a = 0; a < 2; ++a) {
      p.slope(c, a) = (4.0 * L[c] - 1.0) * kSlope[c][a];
      p.slope(3 + c, a) = 4.0 * (L[c] * kSlope[d][a] + L[d] * kSlope[c][a]);
    }
    for (int k = 0; k < 3; ++k) {  // 11, 12, 22
      const int a = k / 2;
      const int b = (k + 1) / 2;
      p.curve(c, k) = 4.0 * kSlope[c][a] * kSlope[c][b];
      p.curve(3 + c, k) =
          4.0 * (kSlope[c][a] * kSlope[d][b] + kSlope[d][a] * kSlope[c][b]);
    }
  }
  p.shape[6] = 27.0 * L[0] * L[1] * L[2];
  for (int a = 0; a < 2; ++a) {
    p.slope(6, a) =
        27.0 * (kSlope[0][a] * L[1] * L[2] + L[0] * kSlope[1][a] * L[2] +
                L[0] * L[1] * kSlope[2][a]);
  }
  p.carried.setZero();
  p.stretched.setZero();
  return p;
}

FacetPoint facet_point(double xi, double eta) {
  static const CarriedForms forms = carried_forms();
  FacetPoint p = facet_functions(xi, eta);
  const auto at = monomials(xi, eta);
  for (int i = 0; i < kFunctions; ++i) {
    for (int j = 0; j < kNodes; ++j) {
      p.carried.block<2, 1>(2 * i, j) = at * forms.monomial[i][j];
    }
  }
  static const StretchedForms tensors = stretched_forms();
  const auto tensor_at = linear_tensors(xi, eta);
  for (int i = 0; i < kNodes; ++i) {
    for (int j = 0; j < kNodes; ++j) {
      p.stretched.block<3, 1>(3 * i, j) = tensor_at * tensors.monomial[i][j];
    }
  }
  return p;
}

const FacetPoint& facet_center() {
  static const FacetPoint center = facet_point(1.0 / 3.0, 1.0 / 3.0);
  return center;
}

const std::array<std::array<EdgePoint, 3>, 3>& edge_rules() {
  static const auto rules = [] {
    std::array<std::array<EdgePoint, 3>, 3> points;
    const std::vector<GaussPoint> gauss = gauss_rule(3);
    for (int e = 0; e < 3; ++e) {
      const double* from = kCorner[e];
      const double* to = kCorner[(e + 1) % 3];
      for (int q = 0; q < 3; ++q) {
        const double s = gauss[q].at;
        points[e][q] = {facet_functions(from[0] + s * (to[0] - from[0]),
                                        from[1] + s * (to[1] - from[1])),
                        gauss[q].weight,
                        {to[0] - from[0], to[1] - from[1]}};
      }
    }
    return points;
  }();
  return rules;
}

const FacetRule& facet_rule() {
  // Dunavant, Int. J. Numer. Methods Eng. 21, 1985: degree four.
  static const FacetRule rule = [] {
    constexpr double kPlace[2] = {0.44594849091596488632,
                                  0.09157621350977074346};
    constexpr double kWeight[2] = {0.22338158967801146570,
                                   0.10995174365532186764};
    FacetRule points;
    for (int k = 0; k < 2; ++k) {
      const double a = kPlace[k];
      const double b = 1.0 - 2.0 * a;
      for (const auto& [xi, eta] : {std::array{a, a}, {b, a}, {a, b}}) {
        points.push_back(facet_point(xi, eta));
        points.back().weight = 0.5 * kWeight[k];
      }
    }
    return points;
  }();
  return rule;
}

}  // namespace meniscus::shell
