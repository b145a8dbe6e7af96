/// The points of a wall's refinements, each made once.
#pragma once

#include <map>
#include <tuple>

#include "evolve/walls/wall_topology.h"

namespace meniscus::walls {

/// A place in a rim strip: between the front and the back point of a column.
/// Inside a cap both are the point itself.
struct StripCorner {
  int front = -1;
  int back = -1;
  double across = 1.0;  // 1 on the front
};

/// Adds points and middles to a topology that is being built.
class WallMiddles {
 public:
  /// Keeps both. `film`: the middles of the film's own refinements.
  WallMiddles(const EdgeMiddles& film, WallTopology& walls)
      : film_(film), walls_(walls) {}

  int add_point(WallPoint point);

  /// The point at a place of a strip.
  int strip_point(const StripCorner& at);

  /// Between two film vertices, points of sides, places of strips or of caps
  /// (along a column as in its strip, else half way). Throws MeshError where
  /// the film has no middle.
  int film_middle(int a, int b) const;
  int side_middle(int a, int b);
  StripCorner strip_middle(const StripCorner& a, const StripCorner& b);
  StripCorner cap_middle(const StripCorner& a, const StripCorner& b);

 private:
  void remember(int a, int b, int middle);

  const EdgeMiddles& film_;
  WallTopology& walls_;
  std::map<std::tuple<int, int, long long>, int> strip_points_;
};

}  // namespace meniscus::walls
