#include "evolve/films/tube_strip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/geometry/plane_points.h"
#include "evolve/films/wall_development.h"

namespace meniscus::films {

namespace {

/// A loop around a cylinder unrolled from a point to the same a turn further.
struct Run {
  std::vector<int> ids;
  Points places;
};

/// A cylinder's loops, unrolled each on its own.
class TubeLoops {
 public:
  TubeLoops(const BentWall& wall, const std::vector<Points>& loops)
      : loops_(loops), plane_{wall} {
    int next = 0;
    for (const Points& loop : loops) {
      angles_.push_back(angles_along(wall, loop));
      first_id_.push_back(next);
      next += static_cast<int>(loop.size());
    }
  }

  double turn(std::size_t loop) const {
    return angles_[loop].back() - angles_[loop].front();
  }
  int size(std::size_t loop) const {
    return static_cast<int>(loops_[loop].size());
  }
  Vec3 place(std::size_t loop, int point, double more) const {
    return plane_.to_plane(angles_[loop][point] + more,
                           about_axis(plane_.wall, loops_[loop][point]).z());
  }

  /// From a point once around, `more` beyond its angle there [rad].
  Run run(std::size_t loop, int from, bool reversed, double more) const {
    Run result;
    const int count = size(loop);
    for (int k = 0; k <= count; ++k) {
      const int step = reversed ? count - k : k;
      const int point = (from + step) % count;
      const bool past = reversed ? k > from : from + k >= count;
      const double turns = past ? (reversed ? -turn(loop) : turn(loop)) : 0.0;
      result.ids.push_back(first_id_[loop] + point);
      result.places.push_back(place(loop, point, more + turns));
    }
    return result;
  }

  /// All of one that does not go around.
  Run hole(std::size_t loop, double more) const {
    Run result;
    for (int k = 0; k < size(loop); ++k) {
      result.ids.push_back(first_id_[loop] + k);
      result.places.push_back(place(loop, k, more));
    }
    return result;
  }

  /// Turns that bring a place beside another, in length along x.
  double beside(const Vec3& at, const Vec3& other) const {
    const double round = 2.0 * std::numbers::pi * plane_.wall.radius;
    return round * std::round((other.x() - at.x()) / round);
  }

 private:
  const std::vector<Points>& loops_;
  WallDevelopment plane_;
  std::vector<std::vector<double>> angles_;
  std::vector<int> first_id_;
};

/// Does a line from a to b of an unrolled tube cross a loop?
bool crosses(const TubeLoops& tube, std::size_t loop, const Vec3& a,
             const Vec3& b) {
  const Run run = tube.hole(loop, 0.0);
  for (std::size_t k = 0; k < run.places.size(); ++k) {
    Vec3 p = run.places[k];
    Vec3 q = run.places[(k + 1) % run.places.size()];
    const double by = tube.beside(0.5 * (p + q), 0.5 * (a + b));
    p.x() += by;
    q.x() += by;
    const std::array<double, 2> sides =
        segment_sides(a.head<2>(), b.head<2>(), p.head<2>(), q.head<2>());
    if (sides[0] <= 0.0 && sides[1] <= 0.0) {
      return true;
    }
  }
  return false;
}

/// The points of both ends that the seam joins.
Edge seam_of(const TubeLoops& tube, const std::array<std::size_t, 2>& ends,
             const std::vector<std::size_t>& holes) {
  double least = std::numeric_limits<double>::infinity();
  Edge seam = {-1, -1};
  for (int i = 0; i < tube.size(ends[0]); ++i) {
    const Vec3 a = tube.place(ends[0], i, 0.0);
    for (int j = 0; j < tube.size(ends[1]); ++j) {
      Vec3 b = tube.place(ends[1], j, 0.0);
      b.x() += tube.beside(b, a);
      const double length = (b - a).norm();
      if (length < least &&
          std::none_of(holes.begin(), holes.end(), [&](std::size_t hole) {
            return crosses(tube, hole, a, b);
          })) {
        least = length;
        seam = {i, j};
      }
    }
  }
  if (seam[0] < 0) {
    throw MeshError("no line along the cylinder passes its holes");
  }
  return seam;
}

}  // namespace

TubeStrip cut_open(const BentWall& wall, const std::vector<Points>& loops,
                   const std::array<std::size_t, 2>& ends, double edge) {
  const TubeLoops tube(wall, loops);
  std::vector<std::size_t> holes;
  int next = 0;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    next += tube.size(k);
    if (k != ends[0] && k != ends[1]) {
      holes.push_back(k);
    }
  }
  const Edge seam = seam_of(tube, ends, holes);
  // Around the first loop, along the seam, around the second the other way,
  // and back along the seam's other side.
  const Run first = tube.run(ends[0], seam[0], false, 0.0);
  const Vec3 start = first.places.front();
  const Vec3 over = first.places.back() - start;
  const bool reversed = tube.turn(ends[0]) * tube.turn(ends[1]) > 0.0;
  const Run second = tube.run(
      ends[1], seam[1], reversed,
      tube.beside(tube.place(ends[1], seam[1], 0.0), first.places.back()) /
          wall.radius);
  const Vec3 way = second.places.back() - start;
  const auto pieces =
      std::max(1, static_cast<int>(std::lround(way.norm() / edge)));
  TubeStrip result;
  const auto add = [&result](const Run& run, Points& places) {
    places.insert(places.end(), run.places.begin(), run.places.end());
    result.ids.insert(result.ids.end(), run.ids.begin(), run.ids.end());
  };
  Run back;
  Run forth;
  for (int k = 1; k < pieces; ++k) {
    result.seam.emplace_back(start + way * k / pieces);
    forth.places.emplace_back(result.seam.back() + over);
    forth.ids.push_back(next + k - 1);
  }
  back.places.assign(result.seam.rbegin(), result.seam.rend());
  back.ids.assign(forth.ids.rbegin(), forth.ids.rend());
  for (const Run& run : {first, forth, second, back}) {
    add(run, result.rim);
  }
  const Vec3 middle = start + 0.5 * (way + over);
  for (const std::size_t hole : holes) {
    // Half a turn either way of the middle between the seam's sides there.
    const Vec3 at = tube.place(hole, 0, 0.0);
    const Vec3 there = middle + way * ((at.y() - middle.y()) / way.y());
    add(tube.hole(hole, tube.beside(at, there) / wall.radius),
        result.holes.emplace_back());
  }
  return result;
}

}  // namespace meniscus::films
