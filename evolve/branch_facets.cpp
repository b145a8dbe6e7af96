#include "evolve/branch_facets.h"

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/hull.h"
#include "evolve/rim_stitcher.h"

namespace meniscus {

std::vector<Triangle> branch_facets(const FilmSpec& film, const Points& points,
                                    const std::vector<int>& counts) {
  std::vector<Triangle> facets;
  try {
    facets = convex_hull(points);
  } catch (const MeshError& error) {
    throw InvalidInput(fmt::format("film '{}': {}", film.name, error.what()));
  }
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
      const Vec3& p = points[off];
      throw InvalidInput(fmt::format(
          "film '{}': curve '{}' is off the convex hull of the film's curves "
          "near ({:.6g}, {:.6g}, {:.6g}); a branch film starts from that hull: "
          "move or turn the curve, make it convex, or use films of another "
          "kind",
          film.name, film.curves[r], p.x(), p.y(), p.z()));
    }
    border += counts[r];
    first += counts[r];
  }
  if (stitcher.open_edges() != border) {
    throw InvalidInput(fmt::format(
        "film '{}': its convex hull is open away from its curves; a curve is "
        "not planar or not convex: use films of another kind",
        film.name));
  }
  return facets;
}

}  // namespace meniscus
