#include "pipeline/forward/planes_kept.h"

#include <fmt/format.h>

#include "pipeline/case_data/case_symmetry.h"

namespace meniscus::forward {

std::optional<Failure> beyond_planes(const case_data::Case& input,
                                     const SurfaceMesh& films) {
  constexpr double kReach = 1e-6;  // of the size: rims slide on planes
  const double reach = kReach * bounding_diagonal(films.points);
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    double most = reach;
    int label = -1;
    Vec3 at = Vec3::Zero();
    for (std::size_t f = 0; f < films.facets.size(); ++f) {
      for (const int v : films.facets[f]) {
        const Vec3& point = films.points[v];
        const double off = case_data::beyond(input.symmetry[p], point);
        if (off > most) {
          most = off;
          label = films.facet_label[f];
          at = point;
        }
      }
    }
    if (label >= 0) {
      return Failure{
          FailureKind::SurfaceInvalid,
          fmt::format(
              "'{}' passes plane {} of symmetry ({}) by {:.4g} at ({:.4g}, "
              "{:.4g}, {:.4g}) and overlaps its image; take less volume "
              "or thickness, move its curves away from the plane, or turn the "
              "normal of a disk's "
              "curve that lies in it",
              films.labels[label], p + 1, place(input, input.symmetry[p].line),
              most, at.x(), at.y(), at.z())};
    }
  }
  return std::nullopt;
}

}  // namespace meniscus::forward
