#include "cad/solid/spline.h"

#include <algorithm>

#include <Eigen/Core>

#include "core/math/dense.h"

namespace meniscus::solid {

namespace {

constexpr int kDegree = 3;
constexpr double kTangentWeight = 1e4;

int span_of(const std::vector<double>& knots, double x) {
  const int poles = static_cast<int>(knots.size()) - kDegree - 1;
  const auto after =
      std::upper_bound(knots.begin() + kDegree, knots.begin() + poles, x);
  return static_cast<int>(after - knots.begin()) - 1;
}

}  // namespace

SplineBasis spline_basis(const std::vector<double>& knots, double x) {
  x = std::clamp(x, knots.front(), knots.back());
  const int span = span_of(knots, x);
  std::array<double, 4> n{1.0, 0.0, 0.0, 0.0};
  std::array<double, 4> lower{};  // the basis of one degree less
  for (int degree = 1; degree <= kDegree; ++degree) {
    lower = n;
    double saved = 0.0;
    for (int r = 0; r < degree; ++r) {
      const double right = knots[span + r + 1] - x;
      const double left = x - knots[span + 1 - degree + r];
      const double share = lower[r] / (right + left);
      n[r] = saved + right * share;
      saved = left * share;
    }
    n[degree] = saved;
  }
  SplineBasis result;
  result.first = span - kDegree;
  result.value = n;
  for (int r = 0; r <= kDegree; ++r) {
    const int i = result.first + r;
    double slope = 0.0;
    if (r > 0) {
      slope += lower[r - 1] / (knots[i + kDegree] - knots[i]);
    }
    if (r < kDegree) {
      slope -= lower[r] / (knots[i + kDegree + 1] - knots[i + 1]);
    }
    result.slope[r] = kDegree * slope;
  }
  return result;
}

std::vector<double> clamped_knots(const std::vector<SplineBreak>& inner) {
  std::vector<double> knots(kDegree + 1, 0.0);
  for (const SplineBreak& b : inner) {
    knots.insert(knots.end(), b.multiplicity, b.at);
  }
  knots.insert(knots.end(), kDegree + 1, 1.0);
  return knots;
}

Vec3 point_of(const SplineCurve& curve, double t) {
  const SplineBasis basis = spline_basis(curve.knots, t);
  Vec3 point = Vec3::Zero();
  for (int r = 0; r < 4; ++r) {
    point += basis.value[r] * curve.poles[basis.first + r];
  }
  return point;
}

Vec3 slope_of(const SplineCurve& curve, double t) {
  const SplineBasis basis = spline_basis(curve.knots, t);
  Vec3 slope = Vec3::Zero();
  for (int r = 0; r < 4; ++r) {
    slope += basis.slope[r] * curve.poles[basis.first + r];
  }
  return slope;
}

SurfaceJet jet_of(const SplineSurface& surface, const Vec2& at) {
  const SplineBasis a = spline_basis(surface.knots_a, at[0]);
  const SplineBasis b = spline_basis(surface.knots_b, at[1]);
  const int columns = static_cast<int>(surface.knots_b.size()) - 4;
  SurfaceJet jet{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const Vec3& pole = surface.poles[(a.first + i) * columns + b.first + j];
      jet.point += a.value[i] * b.value[j] * pole;
      jet.by_a += a.slope[i] * b.value[j] * pole;
      jet.by_b += a.value[i] * b.slope[j] * pole;
    }
  }
  return jet;
}

SplineCurve fit_curve(const CurveFit& fit) {
  const int poles = static_cast<int>(fit.knots.size()) - 4;
  const int n = 3 * (poles - 2);  // the first and the last are given
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  VectorX right = VectorX::Zero(n);
  const auto fixed = [&](int i) -> const Vec3& {
    return i == 0 ? fit.start : fit.end;
  };
  // One row per coordinate: sum of weights[r] pole[first + r] = target.
  const auto add = [&](int first, const std::array<double, 4>& weights,
                       Vec3 target, double importance) {
    for (int r = 0; r < 4; ++r) {
      if (first + r == 0 || first + r == poles - 1) {
        target -= weights[r] * fixed(first + r);
      }
    }
    for (int r = 0; r < 4; ++r) {
      const int i = first + r - 1;
      if (i < 0 || i >= poles - 2) {
        continue;
      }
      for (int q = 0; q < 4; ++q) {
        const int j = first + q - 1;
        if (j >= 0 && j < poles - 2) {
          for (int k = 0; k < 3; ++k) {
            normal(3 * i + k, 3 * j + k) +=
                importance * weights[r] * weights[q];
          }
        }
      }
      right.segment<3>(3 * i) += importance * weights[r] * target;
    }
  };
  for (std::size_t k = 0; k < fit.at.size(); ++k) {
    const SplineBasis basis = spline_basis(fit.knots, fit.at[k]);
    add(basis.first, basis.value, fit.points[k], 1.0);
  }
  for (int i = 0; i + 4 <= poles; ++i) {
    add(i, {-1.0, 3.0, -3.0, 1.0}, Vec3::Zero(), kThirdDifferenceWeight);
  }
  const auto hold = [&](int pole, const Vec3& direction, const Vec3& end) {
    normal.block<3, 3>(3 * pole, 3 * pole) +=
        kTangentWeight * direction * direction.transpose();
    right.segment<3>(3 * pole) +=
        kTangentWeight * direction * direction.dot(end);
  };
  hold(0, fit.start_normal, fit.start);
  hold(poles - 3, fit.end_normal, fit.end);
  const VectorX solution = solve_ldlt(normal, right);
  SplineCurve curve{fit.knots, Points(poles)};
  curve.poles.front() = fit.start;
  curve.poles.back() = fit.end;
  for (int i = 1; i + 1 < poles; ++i) {
    curve.poles[i] = solution.segment<3>(3 * (i - 1));
  }
  return curve;
}

SplineCurve reversed(const SplineCurve& curve) {
  SplineCurve result = curve;
  std::reverse(result.poles.begin(), result.poles.end());
  std::reverse(result.knots.begin(), result.knots.end());
  for (double& knot : result.knots) {
    knot = 1.0 - knot;
  }
  return result;
}

}  // namespace meniscus::solid
