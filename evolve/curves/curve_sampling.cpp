// Lengths of curves, and how they are cut into edges.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/curves/arc_side.h"
#include "evolve/curves/curve_copy.h"

namespace meniscus::curves {

namespace {

using curve_shape::part_count;

constexpr double kHalfTurn = std::numbers::pi;

// Arclength of an ellipse from angle 0 at equal steps of the angle: 5-point
// Gauss on each step, exact to rounding for any usual ratio of radii.
std::vector<double> ellipse_lengths(const Ellipse& e) {
  constexpr int kSteps = 2048;
  constexpr std::array<double, 5> kAt = {-0.906179845938664, -0.538469310105683,
                                         0.0, 0.538469310105683,
                                         0.906179845938664};
  constexpr std::array<double, 5> kWeight = {
      0.236926885056189, 0.478628670499366, 0.568888888888889,
      0.478628670499366, 0.236926885056189};
  const double h = 2.0 * kHalfTurn / kSteps;
  std::vector<double> lengths(kSteps + 1, 0.0);
  for (int i = 0; i < kSteps; ++i) {
    double sum = 0.0;
    for (std::size_t g = 0; g < kAt.size(); ++g) {
      const double a = h * (i + 0.5 + 0.5 * kAt[g]);
      sum += kWeight[g] *
             std::hypot(e.radius_1 * std::sin(a), e.radius_2 * std::cos(a));
    }
    lengths[i + 1] = lengths[i] + 0.5 * h * sum;
  }
  return lengths;
}

/// Where a part lies that has no closed form for its arclength: cut so often
/// that chords are arcs.
struct PartTable {
  std::vector<double> t;
  std::vector<double> lengths;  // along, from 0
};

constexpr int kTableSteps = 2048;      // in all
constexpr int kTableStepsOfPart = 16;  // at least

PartTable part_table(const CurveShape& shape, int part) {
  const int parts = part_count(shape);
  int steps = std::max(kTableStepsOfPart, kTableSteps / parts);
  if (const auto* spline = std::get_if<Spline>(&shape)) {
    steps = std::max(
        steps, kTableStepsOfPart * static_cast<int>(spline->points.size()));
  }
  PartTable table;
  for (int k = 0; k <= steps; ++k) {
    table.t.push_back((part + static_cast<double>(k) / steps) / parts);
  }
  const Points points = points_at(shape, table.t);
  table.lengths.push_back(0.0);
  for (std::size_t k = 1; k < points.size(); ++k) {
    table.lengths.push_back(table.lengths.back() +
                            (points[k] - points[k - 1]).norm());
  }
  return table;
}

bool needs_table(const CurveShape& shape) {
  return std::holds_alternative<Spline>(shape) ||
         std::holds_alternative<CurveCopy>(shape);
}

double part_length(const Polyline& line, int part) {
  const Vec3& from = line.corners[part];
  const Vec3& to = line.corners[(part + 1) % line.corners.size()];
  const std::optional<Vec3>& via = line.via[part];
  if (!via) {
    return (to - from).norm();
  }
  const auto arc = curve_shape::arc_through<double>(from, *via, to);
  return arc.angle * arc.u.norm();
}

double part_length(const CurveShape& shape, int part) {
  if (needs_table(shape)) {
    return part_table(shape, part).lengths.back();
  }
  if (const auto* p = std::get_if<Polyline>(&shape)) {
    return part_length(*p, part);
  }
  if (const auto* c = std::get_if<Circle>(&shape)) {
    return 2.0 * kHalfTurn * c->radius;
  }
  if (const auto* e = std::get_if<Ellipse>(&shape)) {
    return ellipse_lengths(*e).back();
  }
  if (const auto* r = std::get_if<Rectangle>(&shape)) {
    const bool round = r->corner_radius > 0.0;
    if (round && part % 2 == 1) {
      return 0.5 * kHalfTurn * r->corner_radius;
    }
    const int side = round ? part / 2 : part;
    return (side % 2 == 0 ? r->height : r->width) - 2.0 * r->corner_radius;
  }
  const Points& points = std::get<Polygon>(shape).points;
  return (points[(part + 1) % points.size()] - points[part]).norm();
}

/// Adds a part cut into pieces of equal length.
void add_pieces(const PartTable& table, int pieces,
                std::vector<double>& result) {
  const std::vector<double>& lengths = table.lengths;
  std::size_t at = 0;
  for (int i = 0; i < pieces; ++i) {
    const double wanted = lengths.back() * i / pieces;
    while (lengths[at + 1] <= wanted) {
      ++at;
    }
    const double share =
        (wanted - lengths[at]) / (lengths[at + 1] - lengths[at]);
    result.push_back((1.0 - share) * table.t[at] + share * table.t[at + 1]);
  }
}

std::vector<double> sample_ellipse(const Ellipse& e, int pieces) {
  const std::vector<double> lengths = ellipse_lengths(e);
  const double step = 1.0 / static_cast<double>(lengths.size() - 1);
  std::vector<double> result;
  std::size_t at = 0;
  for (int i = 0; i < pieces; ++i) {
    const double wanted = lengths.back() * i / pieces;
    while (lengths[at + 1] <= wanted) {
      ++at;
    }
    const double share =
        (wanted - lengths[at]) / (lengths[at + 1] - lengths[at]);
    result.push_back(step * (static_cast<double>(at) + share));
  }
  return result;
}

// Pieces per part: about `edge` long, at least one, an even number in all.
std::vector<int> pieces_per_part(const std::vector<double>& lengths,
                                 double edge, int least) {
  double total = 0.0;
  for (const double length : lengths) {
    total += length;
  }
  const double size = std::min(edge, total / least);
  std::vector<int> pieces;
  int sum = 0;
  for (const double length : lengths) {
    pieces.push_back(std::max(1, static_cast<int>(std::lround(length / size))));
    sum += pieces.back();
  }
  while (sum < least || sum % 2 != 0) {
    std::size_t coarsest = 0;
    for (std::size_t i = 1; i < lengths.size(); ++i) {
      if (lengths[i] / pieces[i] >
          (1.0 + 1e-9) * lengths[coarsest] / pieces[coarsest]) {
        coarsest = i;
      }
    }
    ++pieces[coarsest];
    ++sum;
  }
  return pieces;
}

}  // namespace

double length_of(const CurveShape& shape) {
  double sum = 0.0;
  for (int part = 0; part < part_count(shape); ++part) {
    sum += part_length(shape, part);
  }
  return sum;
}

std::vector<double> sample_parameters(const CurveShape& shape, double edge,
                                      int least) {
  if (!std::isfinite(edge) || edge <= 0.0) {
    throw InvalidInput(fmt::format("edge length is {}, must be above 0", edge));
  }
  if (std::holds_alternative<ParametricCurve>(shape)) {
    throw InvalidInput("a parametric curve has no range to cut into edges");
  }
  const int parts = part_count(shape);
  std::vector<double> lengths(parts);
  for (int part = 0; part < parts; ++part) {
    lengths[part] = part_length(shape, part);
  }
  constexpr double kMostPieces = 1e6;
  const double total = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  if (!(total <= kMostPieces * edge)) {
    throw InvalidInput(
        fmt::format("a curve of length {:.4g} has more than a million edges of "
                    "{:.4g}; is a "
                    "number of one of them wrong?",
                    total, edge));
  }
  const std::vector<int> pieces = pieces_per_part(lengths, edge, least);
  if (const auto* e = std::get_if<Ellipse>(&shape)) {
    return sample_ellipse(*e, pieces.front());
  }
  std::vector<double> result;
  for (int part = 0; part < parts; ++part) {
    if (needs_table(shape)) {
      add_pieces(part_table(shape, part), pieces[part], result);
      continue;
    }
    for (int i = 0; i < pieces[part]; ++i) {
      result.push_back((part + static_cast<double>(i) / pieces[part]) / parts);
    }
  }
  return result;
}

}  // namespace meniscus::curves
