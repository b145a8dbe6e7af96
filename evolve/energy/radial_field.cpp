#include "evolve/energy/radial_field.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/math/gauss_rule.h"

namespace meniscus::energy {

namespace {

struct RayPoint {
  double t;
  double weight;  // of phi(t), t^2 dt included
};

/// Gauss's points on [0, 1], on each of its spans.
std::vector<RayPoint> plain_rule(int spans) {
  constexpr int kPoints = 8;
  std::vector<RayPoint> rule;
  for (int span = 0; span < spans; ++span) {
    for (const GaussPoint& g : gauss_rule(kPoints)) {
      const double t = (span + g.at) / spans;
      rule.push_back({t, t * t * g.weight / spans});
    }
  }
  return rule;
}

/// In s on [0, 1] with t = s^2.
std::vector<RayPoint> pole_rule() {
  constexpr int kPoints = 16;
  std::vector<RayPoint> rule;
  for (const GaussPoint& g : gauss_rule(kPoints)) {
    const double t = g.at * g.at;
    rule.push_back({t, t * t * 2.0 * g.at * g.weight});
  }
  return rule;
}

constexpr int kMostSpans = 16;
constexpr int kFirstPlace = 3;  // of a pole: after strength, power and core

const std::vector<RayPoint>& ray_rule(const films::RayOrigin& origin) {
  static const auto kPlain = [] {
    std::array<std::vector<RayPoint>, kMostSpans> rules;
    for (int spans = 1; spans <= kMostSpans; ++spans) {
      rules[spans - 1] = plain_rule(spans);
    }
    return rules;
  }();
  static const std::vector<RayPoint> kPole = pole_rule();
  return origin.is_pole ? kPole
                        : kPlain[std::clamp(origin.spans, 1, kMostSpans) - 1];
}

Vec3 place_of(const films::RayOrigin& origin, Numbers numbers) {
  if (origin.moving_points == 0) {
    return origin.at;
  }
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < origin.moving_points; ++k) {
    const double* at = &numbers[static_cast<std::size_t>(kFirstPlace + 3 * k)];
    sum += Vec3(at[0], at[1], at[2]);
  }
  return sum / origin.moving_points;
}

/// F and its derivative from what the ray's points give.
FieldJet along(const Vec3& ray, const PlaceJet& sum) {
  FieldJet jet;
  jet.value = sum.value * ray;
  jet.slope =
      sum.value * Eigen::Matrix3d::Identity() + ray * sum.gradient.transpose();
  return jet;
}

}  // namespace

FieldJet radial_field(const PlaceField& phi, Numbers numbers,
                      const films::RayOrigin& origin, const Vec3& at) {
  const Vec3 from = place_of(origin, numbers);
  const Vec3 ray = at - from;
  PlaceJet sum;
  for (const RayPoint& point : ray_rule(origin)) {
    const PlaceJet part = jet_at(phi, numbers, from + point.t * ray);
    sum.value += point.weight * part.value;
    sum.gradient += point.weight * point.t * part.gradient;
    sum.hessian += point.weight * point.t * point.t * part.hessian;
  }
  FieldJet jet = along(ray, sum);
  for (int m = 0; m < 3; ++m) {
    jet.bend[m] = ray[m] * sum.hessian;
    jet.bend[m].row(m) += sum.gradient.transpose();
    jet.bend[m].col(m) += sum.gradient;
  }
  return jet;
}

Vec3 radial_value(const PlaceField& phi, Numbers numbers,
                  const films::RayOrigin& origin, const Vec3& at) {
  const Vec3 from = place_of(origin, numbers);
  const Vec3 ray = at - from;
  double sum = 0.0;
  for (const RayPoint& point : ray_rule(origin)) {
    sum += point.weight * value_at(phi, numbers, from + point.t * ray);
  }
  return sum * ray;
}

namespace {

/// Sums of a ray of phi itself, and how these change with where it begins: what
/// a moving pole asks beside its numbers.
struct ByOrigin {
  PlaceJet here;
  Vec3 value = Vec3::Zero();
  Mat3 gradient = Mat3::Zero();

  void add(const RayPoint& point, const PlaceJet& part) {
    here.value += point.weight * part.value;
    here.gradient += point.weight * point.t * part.gradient;
    value += point.weight * (1.0 - point.t) * part.gradient;
    gradient += point.weight * point.t * (1.0 - point.t) * part.hessian;
  }
};

}  // namespace

FieldJet radial_rate(const PlaceField& phi, Numbers numbers, Numbers rates,
                     const films::RayOrigin& origin, const Vec3& at) {
  const Vec3 from = place_of(origin, numbers);
  const Vec3 ray = at - from;
  PlaceJet sum;
  ByOrigin by_origin;
  for (const RayPoint& point : ray_rule(origin)) {
    const Vec3 place = from + point.t * ray;
    const PlaceJet part = rate_at(phi, numbers, rates, place);
    sum.value += point.weight * part.value;
    sum.gradient += point.weight * point.t * part.gradient;
    if (origin.moving_points > 0) {
      by_origin.add(point, jet_at(phi, numbers, place));
    }
  }
  FieldJet jet = along(ray, sum);
  if (origin.moving_points > 0) {
    const Vec3 way = place_of(origin, rates);
    const double grows = by_origin.value.dot(way);
    jet.value += grows * ray - by_origin.here.value * way;
    jet.slope += grows * Mat3::Identity() -
                 way * by_origin.here.gradient.transpose() +
                 ray * (by_origin.gradient * way).transpose();
  }
  return jet;
}

void add_radial_by_numbers(const PlaceField& phi, Numbers numbers,
                           const films::RayOrigin& origin, const Vec3& at,
                           const Vec3& by_value,
                           const Eigen::Matrix3d& by_slope, VectorX& sum) {
  const Vec3 from = place_of(origin, numbers);
  const Vec3 ray = at - from;
  const double value = by_value.dot(ray) + by_slope.trace();
  const Vec3 gradient = by_slope.transpose() * ray;
  ByOrigin by_origin;
  for (const RayPoint& point : ray_rule(origin)) {
    const Vec3 place = from + point.t * ray;
    add_by_numbers(phi, numbers, place, point.weight * value,
                   point.weight * point.t * gradient, sum);
    if (origin.moving_points > 0) {
      by_origin.add(point, jet_at(phi, numbers, place));
    }
  }
  const Vec3 by_from =
      value * by_origin.value - by_origin.here.value * by_value -
      by_slope * by_origin.here.gradient + by_origin.gradient * gradient;
  for (int k = 0; k < origin.moving_points; ++k) {
    sum.segment<3>(kFirstPlace + 3 * k) += by_from / origin.moving_points;
  }
}

}  // namespace meniscus::energy
