#include "evolve/walls/wall_offset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/math/dense.h"
#include "evolve/walls/facet_probe.h"

namespace meniscus::walls {

namespace {

constexpr double kLongestMitre = 3;     // a sharper mitre is cut there
constexpr double kFlatHold = 1e-6;      // of the tangential move, see header
constexpr double kLargestFix = 1.5;     // of a correction, per pass
constexpr double kSlow = 0.95;          // a pass that gains less is the last
constexpr double kTotalFix = 4.0;       // of all corrections together
constexpr double kInEdge = 1e-9;        // of a facet's area
constexpr double kInFront = 1e-9;       // rounding of n . d >= h, of d
constexpr double kLeastSpanned = 1e-6;  // of planes that meet in a corner

double corner_angle(const Sheet& sheet, int facet, int v) {
  const Triangle& t = sheet.film.facets[facet];
  const int at = t[0] == v ? 0 : (t[1] == v ? 1 : 2);
  const Vec3 a = sheet.film.points[t[(at + 1) % 3]] - sheet.film.points[v];
  const Vec3 b = sheet.film.points[t[(at + 2) % 3]] - sheet.film.points[v];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Vec3 mitre(const Mat3& matrix, const Vec3& right) {
  const Vec3 d = mitre_inverse(matrix) * right;
  const double length = d.norm();
  return length > kLongestMitre ? Vec3(d * (kLongestMitre / length)) : d;
}

Vec3 mitre_in(const Mat3& along, const Mat3& matrix, const Vec3& right) {
  return mitre(along * matrix * along, along * right);
}

/// Measures a wall; per vertex the range of measured / asked around it.
class Gauge {
 public:
  Gauge(const Sheet& sheet, const std::vector<double>& asked,
        const SheetEnds& ends)
      : sheet_(sheet), asked_(asked), ends_(ends) {}

  void measure(const Points& front, const Points& back) {
    low_.assign(asked_.size(), std::numeric_limits<double>::infinity());
    high_.assign(asked_.size(), 0.0);
    least_ = std::numeric_limits<double>::infinity();
    most_ = 0.0;
    side(front, back);
    side(back, front);
  }

  double worst() const { return std::max(1.0 - least_, most_ - 1.0); }
  const MeasuredThickness& thinnest() const { return thinnest_; }
  const MeasuredThickness& thickest() const { return thickest_; }
  /// Middle of measured / asked over the samples that vertex v moves.
  double middle(int v) const { return 0.5 * (low_[v] + high_[v]); }

 private:
  template <typename Corners>
  void sample(const Points& side, const Points& other, const FacetProbe& probe,
              const Corners& corners) {
    Vec3 p = Vec3::Zero();
    Vec3 across = Vec3::Zero();
    double asked = 0.0;
    for (const int v : corners) {
      p += side[v];
      across += other[v];
      asked += asked_[v];
    }
    const auto count = static_cast<double>(corners.size());
    p /= count;
    asked /= count;
    // The same place on the other side is near the nearest.
    const double bound = (across / count - p).norm();
    const FacetProbe::Hit hit = probe.nearest(p, bound);
    const bool cut = hit.facet >= 0
                         ? is_cut(other, hit)
                         : std::all_of(corners.begin(), corners.end(),
                                       [&](int v) { return ends_.slides(v); });
    if (cut) {
      return;
    }
    const double value = hit.distance;
    const double ratio = value / asked;
    if (ratio < least_) {
      least_ = ratio;
      thinnest_ = {value, asked, p};
    }
    if (ratio > most_) {
      most_ = ratio;
      thickest_ = {value, asked, p};
    }
    for (const int v : corners) {
      low_[v] = std::min(low_[v], ratio);
      high_[v] = std::max(high_[v], ratio);
    }
  }

  /// Does the place lie between corners that stay in planes?
  bool is_cut(const Points& points, const FacetProbe::Hit& hit) const {
    if (ends_.along.empty()) {
      return false;
    }
    const Triangle& t = sheet_.film.facets[hit.facet];
    const double all =
        (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm();
    bool cut = false;
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = points[t[(k + 1) % 3]] - hit.point;
      const Vec3 b = points[t[(k + 2) % 3]] - hit.point;
      const bool counts = a.cross(b).norm() > kInEdge * all;
      if (counts && !ends_.slides(t[k])) {
        return false;
      }
      cut = cut || counts;
    }
    return cut;
  }

  void side(const Points& points, const Points& other) {
    const FacetProbe probe(other, sheet_.film.facets);
    for (int v = 0; v < static_cast<int>(points.size()); ++v) {
      sample(points, other, probe, std::array<int, 1>{v});
    }
    for (const Edge& e : sheet_.edges) {
      sample(points, other, probe, e);
    }
    for (const Triangle& t : sheet_.film.facets) {
      sample(points, other, probe, t);
    }
  }

  const Sheet& sheet_;
  const std::vector<double>& asked_;
  const SheetEnds& ends_;
  std::vector<double> low_;
  std::vector<double> high_;
  double least_ = 0.0;
  double most_ = 0.0;
  MeasuredThickness thinnest_;
  MeasuredThickness thickest_;
};

// A side that does not move keeps the film's coordinates bit for bit.
Points moved(const Sheet& sheet, const std::vector<Vec3>& direction,
             const std::vector<double>& distance, double share) {
  Points points = sheet.film.points;
  for (std::size_t v = 0; share != 0.0 && v < points.size(); ++v) {
    points[v] += share * distance[v] * direction[v];
  }
  return points;
}

}  // namespace

void add_move(const WallMove& move, std::vector<WallMove>& moves) {
  const auto same =
      std::find_if(moves.begin(), moves.end(),
                   [&](const WallMove& m) { return m.wall == move.wall; });
  if (same == moves.end()) {
    moves.push_back(move);
  } else {
    same->by += move.by;
  }
}

Mat3 mitre_inverse(const Mat3& matrix, double spanned) {
  const auto eigen = symmetric_eigen(matrix);
  Mat3 inverse = Mat3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (eigen.values[i] > spanned * eigen.values[2]) {
      const Vec3 e = eigen.vectors.col(i);
      inverse += e * e.transpose() / eigen.values[i];
    }
  }
  return inverse;
}

OffsetCorner offset_corner(const std::vector<OffsetPlane>& planes) {
  const auto count = static_cast<int>(planes.size());
  const auto corner_of = [&](const std::vector<int>& active, double spanned) {
    Mat3 matrix = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    for (const int i : active) {
      matrix += planes[i].normal * planes[i].normal.transpose();
      right += planes[i].normal * planes[i].offset;
    }
    OffsetCorner corner{.inverse = mitre_inverse(matrix, spanned),
                        .on = std::vector<char>(planes.size(), 0)};
    corner.point = corner.inverse * right;
    for (const int i : active) {
      corner.on[i] = 1;
    }
    return corner;
  };
  const auto is_in_front = [&](const Vec3& d) {
    return std::all_of(planes.begin(), planes.end(), [&](const auto& plane) {
      return plane.normal.dot(d) >= plane.offset - kInFront * d.norm();
    });
  };
  std::optional<OffsetCorner> best;
  const auto consider = [&](const std::vector<int>& active) {
    OffsetCorner corner = corner_of(active, kLeastSpanned);
    if (is_in_front(corner.point) &&
        (!best || corner.point.norm() < best->point.norm())) {
      best = std::move(corner);
    }
  };
  for (int i = 0; i < count; ++i) {
    consider({i});
    for (int j = i + 1; j < count; ++j) {
      consider({i, j});
      for (int k = j + 1; k < count; ++k) {
        consider({i, j, k});
      }
    }
  }
  if (best) {
    return *best;
  }
  std::vector<int> all(planes.size());
  std::iota(all.begin(), all.end(), 0);
  return corner_of(all, 0.05);
}

WallShares shares(WallSide side) {
  switch (side) {
    case WallSide::Inside:
      return {0.0, 1.0};
    case WallSide::Outside:
      return {1.0, 0.0};
    case WallSide::Both:
      break;
  }
  return {0.5, 0.5};
}

std::vector<Vec3> offset_directions(const Sheet& sheet,
                                    const std::vector<Jet>& jets,
                                    const std::vector<double>& asked,
                                    const SheetEnds& ends) {
  std::vector<Vec3> directions;
  directions.reserve(jets.size());
  for (int v = 0; v < static_cast<int>(jets.size()); ++v) {
    const bool slides = ends.slides(v);
    if (slides && sheet.on_crease[v] == 0) {
      const Vec3& n = jets[v].normal;
      directions.push_back(in_planes(*ends.along[v], n, n));
      continue;
    }
    Mat3 matrix = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    for (int k = sheet.facet_start[v]; k < sheet.facet_start[v + 1]; ++k) {
      const int f = sheet.facet_list[k];
      const Vec3& n = sheet.facet_normal[f];
      const double weight = corner_angle(sheet, f, v);
      matrix += weight * n * n.transpose();
      right += weight * n;
    }
    if (sheet.on_crease[v] != 0) {
      directions.push_back(slides ? mitre_in(*ends.along[v], matrix, right)
                                  : mitre(matrix, right));
      continue;
    }
    const Vec3& n = jets[v].normal;
    const double bend =
        asked[v] * std::max(std::abs(jets[v].k1), std::abs(jets[v].k2));
    const double hold = matrix.trace() * (kFlatHold + bend * bend);
    matrix += hold * (Mat3::Identity() - n * n.transpose());
    directions.push_back(solve_ldlt3(matrix, right));
  }
  return directions;
}

OffsetSides offset_sides(const Sheet& sheet, const std::vector<Vec3>& direction,
                         const std::vector<double>& asked,
                         const ThickenOptions& options, const SheetEnds& ends) {
  const WallShares part = shares(options.side);
  std::vector<double> distance = asked;
  Gauge gauge(sheet, asked, ends);
  OffsetSides best;
  double best_error = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass <= options.max_corrections; ++pass) {
    Points front = moved(sheet, direction, distance, part.front);
    Points back = moved(sheet, direction, distance, -part.back);
    for (Points* side : {&front, &back}) {
      make_room(sheet, ends, *side);
    }
    gauge.measure(front, back);
    const bool slow = gauge.worst() > kSlow * best_error;
    if (gauge.worst() < best_error) {
      best_error = gauge.worst();
      best = {std::move(front), std::move(back), gauge.thinnest(),
              gauge.thickest(), pass};
    }
    if (slow || gauge.worst() <= options.accuracy) {
      break;
    }
    for (std::size_t v = 0; v < distance.size(); ++v) {
      // On a crease the mitre is the answer: its tip is further away.
      if (sheet.on_crease[v] == 0 && !ends.slides(static_cast<int>(v))) {
        const double fix = std::clamp(1.0 / gauge.middle(static_cast<int>(v)),
                                      1.0 / kLargestFix, kLargestFix);
        distance[v] = std::clamp(distance[v] * fix, asked[v] / kTotalFix,
                                 asked[v] * kTotalFix);
      }
    }
  }
  return best;
}

}  // namespace meniscus::walls
