#include "evolve/energy/radial_field.h"

#include <vector>

#include "core/math/gauss_rule.h"
#include "evolve/energy/film_space.h"

namespace meniscus::energy {

namespace {

constexpr int kRayPoints = 16;

struct RayPoint {
  double t;
  double weight;  // of phi(t), t^2 dt included
};

/// Gauss's points in s on [0, 1] with t = s^2.
std::vector<RayPoint> make_ray_rule() {
  std::vector<RayPoint> rule;
  for (const GaussPoint& g : gauss_rule(kRayPoints)) {
    const double t = g.at * g.at;
    rule.push_back({t, t * t * 2.0 * g.at * g.weight});
  }
  return rule;
}

}  // namespace

FieldJet radial_field(const Expression& phi, const Vec3& origin,
                      const Vec3& at) {
  static const std::vector<RayPoint> kRule = make_ray_rule();
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
