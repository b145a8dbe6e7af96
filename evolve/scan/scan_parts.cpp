#include "evolve/scan/scan_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/math/union_find.h"

namespace meniscus::scan {

namespace {

/// Facets without area are smaller than this, x the square of the size.
constexpr double kNoArea = 1e-14;

/// Basins that grow together, each known by one of its facets.
class Basins {
 public:
  Basins(std::vector<double> lowest, std::vector<double> area)
      : lowest_(std::move(lowest)),
        area_(std::move(area)),
        sets_(area_.size()) {}

  int root(int f) { return sets_.root(f); }

  /// Joins them over a pass where one is shallow or small.
  void meet(int f, int g, double height, double depth, double least_area) {
    f = root(f);
    g = root(g);
    if (f == g) {
      return;
    }
    const double shallow = height - std::max(lowest_[f], lowest_[g]);
    if (shallow >= depth && std::min(area_[f], area_[g]) >= least_area) {
      return;
    }
    const auto [low, high] = std::minmax(f, g);
    sets_.join(low, high);
    lowest_[low] = std::min(lowest_[f], lowest_[g]);
    area_[low] += area_[high];
  }

 private:
  std::vector<double> lowest_;
  std::vector<double> area_;
  UnionFind sets_;
};

}  // namespace

ScanParts::ScanParts(const SurfaceMesh& scan, double radius)
    : scan_(scan), radius_(radius) {
  list_edges(scan.facets, edges_, facet_edges_);
  at_edge_.resize(edges_.size());
  const double size = bounding_diagonal(scan.points);
  double all = 0.0;
  for (std::size_t f = 0; f < scan.facets.size(); ++f) {
    const Triangle& t = scan.facets[f];
    normal2_.push_back(area_vector2(scan, static_cast<int>(f)));
    area_.push_back(0.5 * normal2_.back().norm());
    center_.push_back(
        (scan.points[t[0]] + scan.points[t[1]] + scan.points[t[2]]) / 3.0);
    if (!(area_.back() > kNoArea * size * size)) {
      area_.back() = 0.0;
      continue;
    }
    all += area_.back();
    for (const int e : facet_edges_[f]) {
      at_edge_[e].push_back(static_cast<int>(f));
    }
  }
  if (!(all > 0.0)) {
    throw MeshError("the scan has no area");
  }
  turn_.assign(edges_.size(), 0.0);
  std::vector<int> seen(scan.facets.size(), -1);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    turn_[e] = turn_at(static_cast<int>(e), seen);
  }
}

/// Between the mean normals of the facets about the edge that can be reached
/// without leaving the ball, on its two sides.
double ScanParts::turn_at(int edge, std::vector<int>& seen) const {
  if (at_edge_[edge].size() != 2) {
    return 0.0;
  }
  const Vec3 middle =
      0.5 * (scan_.points[edges_[edge][0]] + scan_.points[edges_[edge][1]]);
  const int first = at_edge_[edge][0];
  const int second = at_edge_[edge][1];
  // Across the edge, within the surface.
  const Vec3 way =
      scan_.points[edges_[edge][1]] - scan_.points[edges_[edge][0]];
  Vec3 across = center_[second] - center_[first];
  across -= across.dot(way) / way.squaredNorm() * way;
  std::array<Vec3, 2> sum = {Vec3::Zero(), Vec3::Zero()};
  std::vector<int> stack = {first, second};
  seen[first] = seen[second] = edge;
  while (!stack.empty()) {
    const int f = stack.back();
    stack.pop_back();
    const double side = across.dot(center_[f] - middle);
    sum[side < 0.0 ? 0 : 1] += normal2_[f];
    for (const int e : facet_edges_[f]) {
      for (const int g : at_edge_[e]) {
        if ((center_[g] - middle).squaredNorm() <= radius_ * radius_ &&
            seen[g] != edge) {
          seen[g] = edge;
          stack.push_back(g);
        }
      }
    }
  }
  return std::atan2(sum[0].cross(sum[1]).norm(), sum[0].dot(sum[1]));
}

std::vector<int> ScanParts::merged(double turn) const {
  // A facet is as high as its edges, whichever way they run.
  std::vector<double> height(area_.size(), 0.0);
  for (std::size_t f = 0; f < area_.size(); ++f) {
    for (const int e : facet_edges_[f]) {
      height[f] = std::max(height[f], turn_[e]);
    }
  }
  std::vector<int> order;
  std::vector<double> pass(edges_.size(), 0.0);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (at_edge_[e].size() == 2) {
      order.push_back(static_cast<int>(e));
      pass[e] = std::max(height[at_edge_[e][0]], height[at_edge_[e][1]]);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return std::pair(pass[a], turn_[a]) < std::pair(pass[b], turn_[b]);
  });
  Basins basins(height, area_);
  const double least = std::numbers::pi * radius_ * radius_;
  // Small basins that grew only later may be passed over the first time.
  for (int round = 0; round < 2; ++round) {
    for (const int e : order) {
      basins.meet(at_edge_[e][0], at_edge_[e][1], pass[e], turn, least);
    }
  }
  std::vector<int> part(area_.size(), -1);
  for (std::size_t f = 0; f < area_.size(); ++f) {
    if (area_[f] > 0.0) {
      part[f] = basins.root(static_cast<int>(f));
    }
  }
  return part;
}

std::vector<PartBorder> ScanParts::borders(const std::vector<int>& part) const {
  std::map<int, Steps> steps;  // by part
  for (std::size_t f = 0; f < area_.size(); ++f) {
    for (int k = 0; k < 3 && part[f] >= 0; ++k) {
      const int e = facet_edges_[f][k];
      const bool inner = at_edge_[e].size() == 2 &&
                         part[at_edge_[e][0]] == part[at_edge_[e][1]];
      if (!inner) {
        const Triangle& t = scan_.facets[f];
        steps[part[f]][t[k]].push_back({t[(k + 1) % 3], e});
      }
    }
  }
  std::vector<PartBorder> result;
  std::vector<std::vector<int>> known;  // edges of borders, sorted
  for (auto& [p, of_part] : steps) {
    for (auto& [start, out] : of_part) {
      while (std::any_of(out.begin(), out.end(),
                         [](const Step& s) { return !s.used; })) {
        std::vector<int> along;
        PartBorder border = trace_border(of_part, start, along);
        std::sort(along.begin(), along.end());
        if (border.points.size() > 2 &&
            std::find(known.begin(), known.end(), along) == known.end()) {
          known.push_back(along);
          result.push_back(std::move(border));
        }
      }
    }
  }
  return result;
}

/// From `start` along unused steps until it is reached again; no points where
/// it is not.
PartBorder ScanParts::trace_border(Steps& steps, int start,
                                   std::vector<int>& along) const {
  PartBorder border;
  double length = 0.0;
  int at = start;
  do {
    std::vector<Step>& out = steps[at];
    const auto next = std::find_if(out.begin(), out.end(),
                                   [](const Step& s) { return !s.used; });
    if (next == out.end()) {
      return {};
    }
    next->used = true;
    const double piece = (scan_.points[next->to] - scan_.points[at]).norm();
    border.points.push_back(scan_.points[at]);
    border.turn += piece * turn_[next->edge];
    length += piece;
    along.push_back(next->edge);
    at = next->to;
  } while (at != start);
  border.turn /= std::max(length, std::numeric_limits<double>::min());
  return border;
}

}  // namespace meniscus::scan
