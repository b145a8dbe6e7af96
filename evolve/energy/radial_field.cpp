#include "evolve/energy/radial_field.h"

#include <cmath>
#include <numbers>

#include "evolve/energy/film_space.h"

namespace meniscus::energy {

namespace {

constexpr int kRayPoints = 16;

struct RayPoint {
  double t;
  double weight;  // of phi(t), t^2 dt included
};

/// Gauss-Legendre in s on [0, 1] with t = s^2.
std::array<RayPoint, kRayPoints> make_ray_rule() {
  std::array<RayPoint, kRayPoints> rule;
  for (int i = 0; i < kRayPoints; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (kRayPoints + 0.5));
    double slope = 1.0;
    for (int step = 0; step < 10; ++step) {
      double before = 1.0;
      double legendre = x;
      for (int k = 2; k <= kRayPoints; ++k) {
        const double next = ((2 * k - 1) * x * legendre - (k - 1) * before) / k;
        before = legendre;
        legendre = next;
      }
      slope = kRayPoints * (x * legendre - before) / (x * x - 1.0);
      x -= legendre / slope;
    }
    const double s = 0.5 * (1.0 + x);
    const double t = s * s;
    rule[i] = {t, t * t * 2.0 * s / ((1.0 - x * x) * slope * slope)};
  }
  return rule;
}

}  // namespace

FieldJet radial_field(const Expression& phi, const Vec3& origin,
                      const Vec3& at) {
  static const std::array<RayPoint, kRayPoints> kRule = make_ray_rule();
  const Vec3 ray = at - origin;
  PlaceJet sum;
  for (const RayPoint& point : kRule) {
    const PlaceJet part = jet_at(phi, origin + point.t * ray);
    sum.value += point.weight * part.value;
    sum.gradient += point.weight * point.t * part.gradient;
    sum.hessian += point.weight * point.t * point.t * part.hessian;
  }
  FieldJet jet;
  jet.value = sum.value * ray;
  jet.slope =
      sum.value * Eigen::Matrix3d::Identity() + ray * sum.gradient.transpose();
  for (int m = 0; m < 3; ++m) {
    jet.bend[m] = ray[m] * sum.hessian;
    jet.bend[m].row(m) += sum.gradient.transpose();
    jet.bend[m].col(m) += sum.gradient;
  }
  return jet;
}

}  // namespace meniscus::energy
