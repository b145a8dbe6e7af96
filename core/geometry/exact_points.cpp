#include "core/geometry/exact_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/math/golden_section.h"

namespace meniscus {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kEdgeSamples = 128;    // of an edge, for its length
constexpr int kSurfaceSamples = 24;  // of a spline surface, each way
constexpr int kFootSteps = 40;
constexpr double kFoot = 1e-13;     // of a step, to the parameters' range
constexpr double kNearFoot = 1e-6;  // [size of the surface]
constexpr double kOnAxis = 1e-9;    // of the distance from the origin
constexpr double kRounded = 1e-14;  // coordinates, relative
constexpr double kIsFoot = 1e-9;    // cosine between what is left and tangents

double beside(double angle, double near) {
  return angle - kTurn * std::round((angle - near) / kTurn);
}

/// Values and first derivatives of the degree + 1 B-splines that are not zero
/// at t (Cox and de Boor's recurrence); `first` is the number of the first.
struct Basis {
  int first = 0;
  std::vector<double> value;
  std::vector<double> slope;
};

Basis basis_at(const std::vector<double>& knots, int degree, double t) {
  const auto count = static_cast<int>(knots.size()) - degree - 1;
  t = std::clamp(t, knots[degree], knots[count]);
  const auto above =
      std::upper_bound(knots.begin() + degree + 1, knots.begin() + count, t);
  const auto span = static_cast<int>(above - knots.begin()) - 1;
  Basis basis{span - degree, {1.0}, {0.0}};
  for (int d = 1; d <= degree; ++d) {
    std::vector<double> value(d + 1, 0.0);
    std::vector<double> slope(d + 1, 0.0);
    for (int k = 0; k < d; ++k) {
      const double low = knots[span - d + 1 + k];
      const double high = knots[span + 1 + k];
      const double share = basis.value[k] / (high - low);
      value[k] += (high - t) * share;
      value[k + 1] += (t - low) * share;
      slope[k] -= d * share;
      slope[k + 1] += d * share;
    }
    basis.value = std::move(value);
    basis.slope = std::move(slope);
  }
  return basis;
}

struct SurfaceJet {
  Vec3 point;
  Vec3 by_a;
  Vec3 by_b;
};

SurfaceJet jet_of(const ExactSplineSurface& s, const Vec2& place) {
  const Basis a = basis_at(s.knots_a, s.degree_a, place[0]);
  const Basis b = basis_at(s.knots_b, s.degree_b, place[1]);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  Eigen::Vector4d sum_a = sum;
  Eigen::Vector4d sum_b = sum;
  for (int i = 0; i <= s.degree_a; ++i) {
    for (int j = 0; j <= s.degree_b; ++j) {
      const int k = (a.first + i) * s.count_b() + b.first + j;
      Eigen::Vector4d pole;
      pole << s.weights[k] * s.poles[k], s.weights[k];
      sum += a.value[i] * b.value[j] * pole;
      sum_a += a.slope[i] * b.value[j] * pole;
      sum_b += a.value[i] * b.slope[j] * pole;
    }
  }
  const Vec3 point = sum.head<3>() / sum[3];
  return {point, (sum_a.head<3>() - sum_a[3] * point) / sum[3],
          (sum_b.head<3>() - sum_b[3] * point) / sum[3]};
}

struct PointOnCurve {
  double t;
  Vec3 operator()(const ExactLine& c) const {
    return c.point + t * c.direction;
  }
  Vec3 operator()(const ExactEllipse& c) const {
    return c.center + std::cos(t) * c.u + std::sin(t) * c.v;
  }
  Vec3 operator()(const ExactSpline& c) const {
    const Basis basis = basis_at(c.knots, c.degree, t);
    Vec3 sum = Vec3::Zero();
    double weight = 0.0;
    for (int k = 0; k <= c.degree; ++k) {
      const double w = basis.value[k] * c.weights[basis.first + k];
      sum += w * c.poles[basis.first + k];
      weight += w;
    }
    return sum / weight;
  }
};

Vec3 around(const ExactFrame& f, double angle) {
  return std::cos(angle) * f.x + std::sin(angle) * f.y;
}

struct PointOnSurface {
  double a;
  double b;
  Vec3 operator()(const ExactPlane& s) const {
    return s.frame.origin + a * s.frame.x + b * s.frame.y;
  }
  Vec3 operator()(const ExactCylinder& s) const {
    return s.frame.origin + s.radius * around(s.frame, a) + b * s.frame.z;
  }
  Vec3 operator()(const ExactCone& s) const {
    return s.frame.origin +
           (s.radius + b * std::sin(s.angle)) * around(s.frame, a) +
           b * std::cos(s.angle) * s.frame.z;
  }
  Vec3 operator()(const ExactSphere& s) const {
    return s.frame.origin + s.radius * std::cos(b) * around(s.frame, a) +
           s.radius * std::sin(b) * s.frame.z;
  }
  Vec3 operator()(const ExactTorus& s) const {
    return s.frame.origin +
           (s.major + s.minor * std::cos(b)) * around(s.frame, a) +
           s.minor * std::sin(b) * s.frame.z;
  }
  Vec3 operator()(const ExactSplineSurface& s) const {
    return jet_of(s, {a, b}).point;
  }
};

/// Of its parameters: knots before and behind hold no surface.
std::pair<Vec2, Vec2> range_of(const ExactSplineSurface& s) {
  const auto end = [](const std::vector<double>& knots, int degree) {
    return knots[knots.size() - 1 - static_cast<std::size_t>(degree)];
  };
  return {{s.knots_a[s.degree_a], s.knots_b[s.degree_b]},
          {end(s.knots_a, s.degree_a), end(s.knots_b, s.degree_b)}};
}

/// Gauss and Newton's steps from a place; how far it then is.
double seek_foot(const ExactSplineSurface& s, const Vec3& at, Vec2& place) {
  const auto [low, high] = range_of(s);
  for (int step = 0; step < kFootSteps; ++step) {
    const SurfaceJet jet = jet_of(s, place);
    const Vec3 left = at - jet.point;
    Eigen::Matrix2d normal;
    normal << jet.by_a.dot(jet.by_a), jet.by_a.dot(jet.by_b),
        jet.by_a.dot(jet.by_b), jet.by_b.dot(jet.by_b);
    const Vec2 move =
        normal.inverse() * Vec2(jet.by_a.dot(left), jet.by_b.dot(left));
    if (!move.allFinite()) {
      break;
    }
    const Vec2 next = (place + move).cwiseMax(low).cwiseMin(high);
    const double moved = (next - place).cwiseQuotient(high - low).norm();
    place = next;
    if (moved <= kFoot) {
      break;
    }
  }
  return (at - jet_of(s, place).point).norm();
}

Vec2 search_foot(const ExactSplineSurface& s, const Vec3& at) {
  const auto [low, high] = range_of(s);
  const Vec2 size = high - low;
  Vec2 best = low;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSurfaceSamples; ++i) {
    for (int j = 0; j <= kSurfaceSamples; ++j) {
      const Vec2 place = low + size.cwiseProduct(Vec2(i, j) / kSurfaceSamples);
      const double distance = (jet_of(s, place).point - at).norm();
      if (distance < least) {
        least = distance;
        best = place;
      }
    }
  }
  seek_foot(s, at, best);
  return best;
}

struct PlaceOnSurface {
  Vec3 at;
  const Vec2* near;

  double angle_of(const ExactFrame& f) const {
    const Vec3 r = at - f.origin;
    const Vec2 across(r.dot(f.x), r.dot(f.y));
    if (near != nullptr &&
        across.norm() <= kOnAxis * r.norm() + kRounded * at.norm()) {
      return (*near)[0];  // a tip or a pole: any angle
    }
    const double angle = std::atan2(across[1], across[0]);
    return near != nullptr ? beside(angle, (*near)[0]) : angle;
  }
  /// Distance from the axis, and along it.
  static Vec2 profile(const ExactFrame& f, const Vec3& at) {
    const Vec3 r = at - f.origin;
    return {std::hypot(r.dot(f.x), r.dot(f.y)), r.dot(f.z)};
  }
  Vec2 operator()(const ExactPlane& s) const {
    const Vec3 r = at - s.frame.origin;
    return {r.dot(s.frame.x), r.dot(s.frame.y)};
  }
  Vec2 operator()(const ExactCylinder& s) const {
    return {angle_of(s.frame), profile(s.frame, at)[1]};
  }
  Vec2 operator()(const ExactCone& s) const {
    const Vec2 p = profile(s.frame, at);
    return {angle_of(s.frame),
            (p[0] - s.radius) * std::sin(s.angle) + p[1] * std::cos(s.angle)};
  }
  Vec2 operator()(const ExactSphere& s) const {
    const Vec2 p = profile(s.frame, at);
    return {angle_of(s.frame), std::atan2(p[1], p[0])};
  }
  Vec2 operator()(const ExactTorus& s) const {
    const Vec2 p = profile(s.frame, at);
    const double b = std::atan2(p[1], p[0] - s.major);
    return {angle_of(s.frame), near != nullptr ? beside(b, (*near)[1]) : b};
  }
  Vec2 operator()(const ExactSplineSurface& s) const {
    if (near == nullptr) {
      return search_foot(s, at);
    }
    Vec2 place = *near;
    const double distance = seek_foot(s, at, place);
    const SurfaceJet jet = jet_of(s, place);
    const Vec3 left = at - jet.point;
    const double size = jet.by_a.norm() + jet.by_b.norm();
    // At a border a foot need not be square; what is near enough is one.
    const bool foot =
        distance <= kNearFoot * size ||
        std::abs(left.dot(jet.by_a)) + std::abs(left.dot(jet.by_b)) <=
            kIsFoot * size * distance;
    if (foot) {
      return place;
    }
    const Vec2 other = search_foot(s, at);
    return (jet_of(s, other).point - at).norm() < distance ? other : place;
  }
};

/// Columns at right angles, along no axis and no diagonal.
Mat3 askew() {
  return (Eigen::AngleAxisd(0.7, Vec3(2, 3, 6) / 7.0) *
          Eigen::AngleAxisd(0.4, Vec3::UnitX()))
      .toRotationMatrix();
}

}  // namespace

Vec3 point_on(const ExactCurve& curve, double t) {
  return std::visit(PointOnCurve{t}, curve);
}

Vec3 point_on(const ExactSurface& surface, const Vec2& place) {
  return std::visit(PointOnSurface{place[0], place[1]}, surface);
}

Vec2 place_on(const ExactSurface& surface, const Vec3& at, const Vec2& near) {
  return std::visit(PlaceOnSurface{at, &near}, surface);
}

Vec2 place_on(const ExactSurface& surface, const Vec3& at) {
  return std::visit(PlaceOnSurface{at, nullptr}, surface);
}

double nearest_on(const ExactEdge& edge, const Vec3& at) {
  if (const auto* line = std::get_if<ExactLine>(&edge.curve)) {
    return std::clamp((at - line->point).dot(line->direction), edge.first,
                      edge.last);
  }
  const auto distance = [&](double t) {
    return (point_on(edge.curve, t) - at).squaredNorm();
  };
  if (const auto* c = std::get_if<ExactEllipse>(&edge.curve);
      c != nullptr &&
      std::abs(c->u.norm() - c->v.norm()) <= 1e-12 * c->u.norm()) {
    const Vec3 r = at - c->center;
    const double middle = 0.5 * (edge.first + edge.last);
    const double t = beside(std::atan2(r.dot(c->v), r.dot(c->u)), middle);
    if (t >= edge.first && t <= edge.last) {
      return t;
    }
    return distance(edge.first) < distance(edge.last) ? edge.first : edge.last;
  }
  const double step = (edge.last - edge.first) / kEdgeSamples;
  double best = edge.first;
  for (int k = 1; k <= kEdgeSamples; ++k) {
    const double t = edge.first + k * step;
    best = distance(t) < distance(best) ? t : best;
  }
  return golden_section(std::max(best - step, edge.first),
                        std::min(best + step, edge.last), distance);
}

double length_of(const ExactEdge& edge) {
  double sum = 0.0;
  Vec3 last = point_on(edge.curve, edge.first);
  for (int k = 1; k <= kEdgeSamples; ++k) {
    const Vec3 next = point_on(
        edge.curve, edge.first + (edge.last - edge.first) * k / kEdgeSamples);
    sum += (next - last).norm();
    last = next;
  }
  return sum;
}

std::vector<double> equal_pieces(const ExactEdge& edge, int pieces) {
  const auto t_of = [&](double k) {
    return edge.first + (edge.last - edge.first) * k / kEdgeSamples;
  };
  std::vector<double> length = {0.0};
  for (int k = 1; k <= kEdgeSamples; ++k) {
    length.push_back(length.back() + (point_on(edge.curve, t_of(k)) -
                                      point_on(edge.curve, t_of(k - 1)))
                                         .norm());
  }
  std::vector<double> result = {edge.first};
  int k = 0;
  for (int piece = 1; piece < pieces; ++piece) {
    const double wanted = length.back() * piece / pieces;
    while (length[k + 1] < wanted) {
      ++k;
    }
    result.push_back(
        t_of(k + (wanted - length[k]) / (length[k + 1] - length[k])));
  }
  result.push_back(edge.last);
  return result;
}

Points frame_points(const ExactShape& shape) {
  Vec3 low = shape.vertices.at(0);
  Vec3 high = low;
  for (const Vec3& p : shape.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = 0.5 * (high - low).norm();
  const Vec3 middle = 0.5 * (low + high);
  const Mat3 ways = (size > 0.0 ? size : 1.0) * askew();
  return {middle, middle + ways.col(0), middle + ways.col(1),
          middle + ways.col(2)};
}

}  // namespace meniscus
