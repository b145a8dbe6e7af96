#include "evolve/start/branch_facets.h"

#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/start/hull.h"
#include "evolve/start/rim_stitcher.h"

namespace meniscus::start {

namespace {

// How far the points sink, over the size of all of them.
constexpr double kSink = 1e-6;

std::vector<Triangle> hull_of(const films::FilmSpec& film,
                              const Points& points) {
  try {
    return convex_hull(points);
  } catch (const MeshError& error) {
    throw InvalidInput(fmt::format("film '{}': {}", film.name, error.what()));
  }
}

/// What is wrong with a hull as a film's start: a point of the curve that is
/// off it, or, with curve -1, an end elsewhere.
struct Misfit {
  int curve = -1;
  int point = -1;
};

/// Takes the caps off `facets` and joins the rest to the rims.
std::optional<Misfit> fit_rims(const Points& points,
                               const std::vector<int>& counts,
                               std::vector<Triangle>& facets) {
  std::vector<int> rim_of_point;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    rim_of_point.insert(rim_of_point.end(), counts[r], static_cast<int>(r));
  }
  std::erase_if(facets, [&](const Triangle& t) {
    return rim_of_point[t[0]] == rim_of_point[t[1]] &&
           rim_of_point[t[0]] == rim_of_point[t[2]];
  });
  RimStitcher stitcher(points, facets);
  std::size_t border = 0;
  int first = 0;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    const int off = stitcher.stitch(first, counts[r]);
    if (off >= 0) {
      return Misfit{static_cast<int>(r), off};
    }
    border += counts[r];
    first += counts[r];
  }
  if (stitcher.open_edges() != border) {
    return Misfit{};
  }
  return std::nullopt;
}

/// Sunk towards their middle by the square of the distance from it. A face of
/// the hull becomes a paraboloid, and its triangles, which no rule chose
/// before, Delaunay's: rims that lie side by side in one plane are among their
/// edges where they are farther apart than their points.
Points sunk(const Points& points) {
  Vec3 low = points.front();
  Vec3 high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 middle = 0.5 * (low + high);
  const double share = kSink / (high - low).squaredNorm();
  Points result;
  result.reserve(points.size());
  for (const Vec3& p : points) {
    const Vec3 off = p - middle;
    result.push_back(middle + (1.0 - share * off.squaredNorm()) * off);
  }
  return result;
}

}  // namespace

std::vector<Triangle> branch_facets(const films::FilmSpec& film,
                                    const Points& points,
                                    const std::vector<int>& counts) {
  std::vector<Triangle> facets = hull_of(film, points);
  const std::optional<Misfit> misfit = fit_rims(points, counts, facets);
  if (!misfit) {
    return facets;
  }
  std::vector<Triangle> others = hull_of(film, sunk(points));
  if (!fit_rims(points, counts, others)) {
    return others;
  }
  if (misfit->curve < 0) {
    throw InvalidInput(fmt::format(
        "film '{}': its convex hull is open away from its curves; a curve is "
        "not planar or not convex: use films of another kind",
        film.name));
  }
  const Vec3& p = points[misfit->point];
  throw InvalidInput(fmt::format(
      "film '{}': curve '{}' is off the convex hull of the film's curves "
      "near ({:.6g}, {:.6g}, {:.6g}); a branch film starts from that hull: "
      "move or turn the curve, make it convex, or use films of another "
      "kind",
      film.name, film.curves[misfit->curve], p.x(), p.y(), p.z()));
}

}  // namespace meniscus::start
