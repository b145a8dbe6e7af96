#include "evolve/walls/wall_middles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"

namespace meniscus::walls {

namespace {

constexpr double kSteps = 1e9;  // places across a strip are told apart so far

}  // namespace

int WallMiddles::add_point(WallPoint point) {
  walls_.points.push_back(std::move(point));
  return static_cast<int>(walls_.points.size()) - 1;
}

int WallMiddles::strip_point(const StripCorner& at) {
  if (at.across >= 1.0) {
    return at.front;
  }
  if (at.across <= 0.0) {
    return at.back;
  }
  // Strips of films that are turned otherwise share a column the other way.
  const bool turned = at.back < at.front;
  const auto key = std::make_tuple(
      std::min(at.front, at.back), std::max(at.front, at.back),
      std::llround((turned ? 1.0 - at.across : at.across) * kSteps));
  const auto known = strip_points_.find(key);
  if (known != strip_points_.end()) {
    return known->second;
  }
  const int id =
      add_point({.vertex = -1,
                 .of = {{at.front, at.across}, {at.back, 1.0 - at.across}}});
  strip_points_[key] = id;
  return id;
}

int WallMiddles::film_middle(int a, int b) const {
  const auto at = film_.find(edge_key(a, b));
  if (at == film_.end()) {
    throw MeshError(fmt::format(
        "wall: the film's edge between points {} and {} has no middle in the "
        "finer mesh",
        a, b));
  }
  return at->second;
}

int WallMiddles::side_middle(int a, int b) {
  if (a == b) {
    return a;
  }
  const Edge key = edge_key(a, b);
  const auto known = walls_.middles.find(key);
  if (known != walls_.middles.end()) {
    return known->second;
  }
  const int vertex =
      film_middle(walls_.points[a].vertex, walls_.points[b].vertex);
  const int id = add_point({.vertex = vertex, .of = {}});
  walls_.middles[key] = id;
  return id;
}

StripCorner WallMiddles::strip_middle(const StripCorner& a,
                                      const StripCorner& b) {
  const StripCorner middle = {side_middle(a.front, b.front),
                              side_middle(a.back, b.back),
                              0.5 * (a.across + b.across)};
  remember(strip_point(a), strip_point(b), strip_point(middle));
  return middle;
}

void WallMiddles::remember(int a, int b, int middle) {
  walls_.middles.try_emplace(edge_key(a, b), middle);
}

// Along a column as in its strip; inside a cap half way.
StripCorner WallMiddles::cap_middle(const StripCorner& a,
                                    const StripCorner& b) {
  if (a.front == b.front && a.back == b.back) {
    return strip_middle(a, b);
  }
  const int pa = strip_point(a);
  const int pb = strip_point(b);
  const Edge key = edge_key(pa, pb);
  const auto known = walls_.middles.find(key);
  if (known != walls_.middles.end()) {
    return {known->second, known->second, 1.0};
  }
  std::map<int, double> weights;
  for (const int p : {pa, pb}) {
    if (walls_.points[p].vertex >= 0) {
      weights[p] += 0.5;
    }
    for (const auto& [q, w] : walls_.points[p].of) {
      weights[q] += 0.5 * w;
    }
  }
  const int id =
      add_point({.vertex = -1, .of = {weights.begin(), weights.end()}});
  walls_.middles[key] = id;
  return {id, id, 1.0};
}

}  // namespace meniscus::walls
