#include "evolve/walls/wall_slide.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "core/geometry/harmonic.h"

namespace meniscus::walls {

namespace {

constexpr double kStraightOn = 0.87;  // cosine, 30 degrees
constexpr double kRimGoesOn = 0.966;  // cosine of half as much
constexpr double kStiffer = 1.3;      // p: far corners would stretch at 2
constexpr double kCornerReach = 0.6;  // of `reach`: rims' corners need room

/// Length of the shortest way along edges from a held point, up to `reach`;
/// `reach` beyond.
std::vector<double> ways_from_held(const SlideInput& input) {
  const Sheet& sheet = input.sheet;
  const Points& x = sheet.film.points;
  std::vector<double> way(x.size(), input.reach);
  using Open = std::pair<double, int>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (input.held[v] != 0) {
      way[v] = 0.0;
      open.emplace(0.0, static_cast<int>(v));
    }
  }
  while (!open.empty()) {
    const auto [length, v] = open.top();
    open.pop();
    if (length > way[v]) {
      continue;
    }
    for (int k = sheet.edge_start[v]; k < sheet.edge_start[v + 1]; ++k) {
      const Edge& edge = sheet.edges[sheet.edge_list[k]];
      const int w = edge[0] == v ? edge[1] : edge[0];
      const double longer = length + (x[w] - x[v]).norm();
      if (longer < way[w]) {
        way[w] = longer;
        open.emplace(longer, w);
      }
    }
  }
  return way;
}

/// The rim where the sheet ends, but for its junctions.
struct SheetRim {
  std::vector<char> on;  // per point
  Points along;          // its directions; 0 at its corners, which stay
};

SheetRim rim_of(const SlideInput& input) {
  const Sheet& sheet = input.sheet;
  const Points& x = sheet.film.points;
  SheetRim rim{.on = std::vector<char>(x.size(), 0),
               .along = Points(x.size(), Vec3::Zero())};
  std::vector<int> count(x.size(), 0);
  for (std::size_t e = 0; e < sheet.edges.size(); ++e) {
    if (sheet.edge_facets[e][1] >= 0) {
      continue;
    }
    const auto [a, b] = sheet.edges[e];
    const Vec3 way = (x[b] - x[a]).normalized();
    for (const int v : {a, b}) {
      rim.along[v] += rim.along[v].dot(way) < 0.0 ? Vec3(-way) : way;
      rim.on[v] = input.held[v] == 0 ? 1 : 0;
      ++count[v];
    }
  }
  for (std::size_t v = 0; v < x.size(); ++v) {
    const double sum = rim.along[v].norm();
    rim.along[v] = rim.on[v] != 0 && sum > kRimGoesOn * count[v]
                       ? Vec3(rim.along[v] / sum)
                       : Vec3(Vec3::Zero());
  }
  return rim;
}

/// Points where the junctions about the sheet turn a corner.
Points held_corners(const SlideInput& input) {
  const Sheet& sheet = input.sheet;
  const Points& x = sheet.film.points;
  std::map<int, Points> ways;  // from held points along junctions
  for (std::size_t e = 0; e < sheet.edges.size(); ++e) {
    const auto [a, b] = sheet.edges[e];
    if (sheet.edge_facets[e][1] < 0 && input.held[a] != 0 &&
        input.held[b] != 0) {
      const Vec3 way = (x[b] - x[a]).normalized();
      ways[a].push_back(way);
      ways[b].push_back(-way);
    }
  }
  Points corners;
  for (const auto& [v, both] : ways) {
    if (both.size() == 2 && both[0].dot(both[1]) > -kStraightOn) {
      corners.push_back(x[v]);
    }
  }
  return corners;
}

/// Of each facet: what is harmonic has infinite slope at a corner that the
/// sheet is outside of, r^(2/3) at a right angle, and facets next to it would
/// turn over; with a stiffness of r^-p it goes as r^q, q (q - p) = (2/3)^2, and
/// is flat there.
std::vector<double> stiff_at_corners(const SlideInput& input) {
  const Points corners = held_corners(input);
  const Points& x = input.sheet.film.points;
  std::vector<double> stiffness;
  for (const Triangle& t : input.sheet.film.facets) {
    const Vec3 middle = (x[t[0]] + x[t[1]] + x[t[2]]) / 3.0;
    const double around = kCornerReach * input.reach;
    double nearest = around;
    for (const Vec3& corner : corners) {
      nearest = std::min(nearest, (middle - corner).norm());
    }
    stiffness.push_back(std::pow(around / nearest, kStiffer));
  }
  return stiffness;
}

/// Harmonic where `fixed` is 0, three columns a wall.
void make_harmonic(HarmonicProblem& problem) {
  problem.facets.clear();
  for (std::size_t f = 0; f < problem.mesh.size(); ++f) {
    const Triangle& t = problem.mesh[f];
    if (std::any_of(t.begin(), t.end(),
                    [&](int v) { return problem.fixed[v] == 0; })) {
      problem.facets.push_back(static_cast<int>(f));
    }
  }
  if (!problem.facets.empty()) {
    problem.values = harmonic(problem);
  }
}

}  // namespace

Slides slide(const SlideInput& input) {
  const Sheet& sheet = input.sheet;
  const std::size_t count = sheet.film.points.size();
  Slides result{.by = input.slides, .way = ways_from_held(input)};
  const auto columns = 3 * static_cast<Eigen::Index>(input.slides.size());
  HarmonicProblem problem{.points = sheet.film.points,
                          .mesh = sheet.film.facets,
                          .facets = {},
                          .fixed = std::vector<char>(count, 1),
                          .values = Eigen::MatrixXd::Zero(
                              static_cast<Eigen::Index>(count), columns),
                          .stiffness = stiff_at_corners(input)};
  const SheetRim rim = rim_of(input);
  Eigen::Index column = 0;
  for (const auto& [wall, slides] : input.slides) {
    for (std::size_t v = 0; v < count; ++v) {
      problem.values.block<1, 3>(static_cast<Eigen::Index>(v), column) =
          slides[v].transpose();
    }
    column += 3;
  }
  for (std::size_t v = 0; v < count; ++v) {
    const bool stays = rim.on[v] != 0 && rim.along[v].isZero(0.0);
    if (input.held[v] == 0 && !stays && result.way[v] < input.reach) {
      problem.fixed[v] = 0;
    }
  }
  make_harmonic(problem);
  // Rims take what lies along them, corners nothing, and what is inside
  // follows: else a narrow sheet would slide across its rim.
  for (std::size_t v = 0; v < count; ++v) {
    if (problem.fixed[v] != 0 || rim.on[v] == 0) {
      continue;
    }
    auto row = problem.values.row(static_cast<Eigen::Index>(v));
    for (Eigen::Index first = 0; first < columns; first += 3) {
      const Vec3 free = row.segment<3>(first).transpose();
      row.segment<3>(first) = rim.along[v].dot(free) * rim.along[v].transpose();
    }
    problem.fixed[v] = 1;
  }
  make_harmonic(problem);
  column = 0;
  for (auto& [wall, slides] : result.by) {
    for (std::size_t v = 0; v < count; ++v) {
      slides[v] =
          problem.values.block<1, 3>(static_cast<Eigen::Index>(v), column)
              .transpose();
    }
    column += 3;
  }
  return result;
}

}  // namespace meniscus::walls
