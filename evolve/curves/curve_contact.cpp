#include "evolve/curves/curve_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/geometry/surface_mesh.h"
#include "evolve/curves/curve_place.h"

namespace meniscus::curves {

namespace {

constexpr int kChords = 128;
constexpr int kRounds = 30;  // of sliding two points towards each other
constexpr double kShrink = 0.5;

struct Chords {
  std::vector<double> t;
  Points points;
  double size = 0.0;
  double longest = 0.0;
  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();

  explicit Chords(const CurveShape& shape)
      : t(sample_parameters(shape, length_of(shape), kChords)),
        points(points_at(shape, t)),
        size(bounding_diagonal(points)),
        low(points[0]),
        high(points[0]) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      longest = std::max(longest, (end(k) - points[k]).norm());
      low = low.cwiseMin(points[k]);
      high = high.cwiseMax(points[k]);
    }
  }
  const Vec3& end(std::size_t k) const {
    return points[(k + 1) % points.size()];
  }
};

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  double s = 0.0;  // on the first segment
  double u = 0.0;  // on the second
  Vec3 place = Vec3::Zero();
};

/// Ericson, Real-Time Collision Detection, 5.1.9.
Nearest between(const Vec3& p, const Vec3& p_end, const Vec3& q,
                const Vec3& q_end) {
  const Vec3 a = p_end - p;
  const Vec3 b = q_end - q;
  const Vec3 r = p - q;
  const double aa = a.squaredNorm();
  const double bb = b.squaredNorm();
  const double ab = a.dot(b);
  const double c = a.dot(r);
  const double f = b.dot(r);
  const double across = aa * bb - ab * ab;
  Nearest result;
  result.s = across > 1e-14 * aa * bb
                 ? std::clamp((ab * f - c * bb) / across, 0.0, 1.0)
                 : 0.0;
  result.u = (ab * result.s + f) / bb;
  if (result.u < 0.0 || result.u > 1.0) {
    result.u = std::clamp(result.u, 0.0, 1.0);
    result.s = std::clamp((ab * result.u - c) / aa, 0.0, 1.0);
  }
  result.place = p + result.s * a;
  result.distance = (result.place - q - result.u * b).norm();
  return result;
}

/// From samples to the curves: the distance of the places where two points
/// come to lie that slide by smaller and smaller steps.
double slide_together(const CurveShape& a, const CurveShape& b, double s,
                      double u, double step, Vec3& place) {
  double least = (point_at(a, s) - point_at(b, u)).norm();
  for (int round = 0; round < kRounds; ++round) {
    bool moved = false;
    for (const double ds : {-step, 0.0, step}) {
      for (const double du : {-step, 0.0, step}) {
        const double found = (point_at(a, s + ds) - point_at(b, u + du)).norm();
        if (found < least) {
          least = found;
          s += ds;
          u += du;
          moved = true;
        }
      }
    }
    step *= moved ? 1.0 : kShrink;
  }
  place = point_at(a, s);
  return least;
}

std::optional<Vec3> meeting_place(const CurveShape& a, const Chords& first,
                                  const CurveShape& b, const Chords& second,
                                  double near) {
  // Chords are off their curves by less than an eighth of their length.
  const double reach = 0.25 * (first.longest + second.longest) + near;
  if ((first.low.array() > second.high.array() + reach).any() ||
      (second.low.array() > first.high.array() + reach).any()) {
    return std::nullopt;
  }
  // The nearest pair of chords, by the distance of two segments; boxes widened
  // by the reach leave out what cannot meet.
  Nearest best;
  std::size_t best_i = 0;
  std::size_t best_j = 0;
  for (std::size_t i = 0; i < first.points.size(); ++i) {
    const Vec3& p = first.points[i];
    const Vec3& p_end = first.end(i);
    if ((p.cwiseMin(p_end).array() > second.high.array() + reach).any() ||
        (p.cwiseMax(p_end).array() < second.low.array() - reach).any()) {
      continue;
    }
    for (std::size_t j = 0; j < second.points.size(); ++j) {
      const Nearest found = between(p, p_end, second.points[j], second.end(j));
      if (found.distance < best.distance) {
        best = found;
        best_i = i;
        best_j = j;
      }
    }
  }
  if (!(best.distance <= reach)) {
    return std::nullopt;
  }
  // Places on chords become parameters of the curves, and a pattern search
  // slides both points together on the exact curves.
  const auto parameter = [](const Chords& chords, std::size_t k, double share) {
    const double next = k + 1 < chords.t.size() ? chords.t[k + 1] : 1.0;
    return chords.t[k] + share * (next - chords.t[k]);
  };
  Vec3 place = best.place;
  const double least =
      slide_together(a, b, parameter(first, best_i, best.s),
                     parameter(second, best_j, best.u), 0.5 / kChords, place);
  return std::min(least, best.distance) <= near ? std::optional(place)
                                                : std::nullopt;
}

}  // namespace

std::optional<Vec3> meets_itself(const CurveShape& shape, double gap) {
  const Chords chords(shape);
  const Points& p = chords.points;
  const std::size_t n = p.size();
  const auto low = [&](std::size_t k) {
    return std::min(p[k].x(), chords.end(k).x());
  };
  const auto high = [&](std::size_t k) {
    return std::max(p[k].x(), chords.end(k).x());
  };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(
      order.begin(), order.end(),
      [&](std::size_t a, std::size_t b) { return low(a) < low(b); });
  const double near = gap * chords.size;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = order[i];
    for (std::size_t j = i + 1; j < n && low(order[j]) <= high(a) + near; ++j) {
      const std::size_t b = order[j];
      if ((a + 1) % n == b || (b + 1) % n == a) {
        continue;
      }
      const Nearest found = between(p[a], chords.end(a), p[b], chords.end(b));
      if (found.distance <= near) {
        return found.place;
      }
    }
  }
  return std::nullopt;
}

std::vector<CurveMeeting> meetings_of(
    const std::vector<const CurveShape*>& shapes, double gap) {
  std::vector<Chords> chords;
  chords.reserve(shapes.size());
  for (const CurveShape* shape : shapes) {
    chords.emplace_back(*shape);
  }
  std::vector<CurveMeeting> result;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t j = i + 1; j < shapes.size(); ++j) {
      const double near = gap * std::min(chords[i].size, chords[j].size);
      if (const auto at = meeting_place(*shapes[i], chords[i], *shapes[j],
                                        chords[j], near)) {
        result.push_back({static_cast<int>(i), static_cast<int>(j), *at});
      }
    }
  }
  return result;
}

std::optional<double> lie_on_each_other(const CurveShape& a,
                                        const CurveShape& b, double gap) {
  constexpr int kPlaces = 64;
  const auto places = [](const CurveShape& shape) {
    return points_at(shape,
                     sample_parameters(shape, length_of(shape), kPlaces));
  };
  const Points on_a = places(a);
  const Points on_b = places(b);
  const double near =
      gap * std::min(bounding_diagonal(on_a), bounding_diagonal(on_b));
  double most = 0.0;
  for (const bool back : {false, true}) {
    for (const CurvePlace& place :
         nearest_places(back ? a : b, back ? on_b : on_a)) {
      if (!(place.distance <= near)) {
        return std::nullopt;
      }
      most = std::max(most, place.distance);
    }
  }
  return most;
}

}  // namespace meniscus::curves
