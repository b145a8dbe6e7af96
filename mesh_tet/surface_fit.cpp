#include "mesh_tet/surface_fit.h"

#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/geometry/chambers.h"

namespace meniscus::mesh_tet {

namespace {

/// Points half way from a side to what it looks at; the one with the most
/// room among a few sides.
class RoomFinder {
 public:
  explicit RoomFinder(const SurfaceMesh& surface)
      : surface_(surface), all_(surface.facets.size()) {
    std::iota(all_.begin(), all_.end(), 0);
    tree_.emplace(surface, all_);
  }

  std::optional<Vec3> find(const std::vector<int>& sides) const {
    constexpr std::size_t kTries = 16;
    const std::size_t step = std::max<std::size_t>(1, sides.size() / kTries);
    double most = 0.0;
    std::optional<Vec3> best;
    for (std::size_t i = 0; i < sides.size(); i += step) {
      const int facet = sides[i] / 2;
      const Vec3 normal = area_vector2(surface_, facet).normalized();
      const Vec3 direction = sides[i] % 2 == 0 ? Vec3(-normal) : normal;
      const Triangle& t = surface_.facets[facet];
      const Vec3 from = (surface_.points[t[0]] + surface_.points[t[1]] +
                         surface_.points[t[2]]) /
                        3.0;
      const auto hit = tree_->first_hit(from, direction, all_, facet);
      if (hit && hit->distance > most) {
        most = hit->distance;
        best = from + 0.5 * hit->distance * direction;
      }
    }
    return best;
  }

 private:
  const SurfaceMesh& surface_;
  std::vector<int> all_;  // every facet its own part
  std::optional<FacetTree> tree_;
};

}  // namespace

SurfaceFit fit_surface(const SurfaceMesh& surface) {
  SurfaceFit fit;
  const Chambers chambers = find_chambers(surface);
  fit.volumes.assign(body_count(surface), 0.0);
  std::vector<std::vector<int>> cavity_sides(chambers.shells.size());
  bool cavities = false;
  for (const Shell& shell : chambers.shells) {
    if (shell.body >= 0) {
      fit.volumes[shell.body] += shell.volume;
      fit.volume += shell.volume;
    }
    cavities = cavities || (shell.body < 0 && shell.volume > 0.0);
  }
  if (!cavities) {
    return fit;
  }
  for (std::size_t side = 0; side < chambers.shell_of.size(); ++side) {
    const int shell = chambers.shell_of[side];
    if (chambers.shells[shell].body < 0 &&
        chambers.shells[shell].volume > 0.0) {
      cavity_sides[shell].push_back(static_cast<int>(side));
    }
  }
  const RoomFinder rooms(surface);
  for (const std::vector<int>& sides : cavity_sides) {
    if (sides.empty()) {
      continue;
    }
    const auto point = rooms.find(sides);
    if (!point) {
      fit.problem = fmt::format("the cavity around facet {} has no room inside",
                                sides.front() / 2);
      return fit;
    }
    fit.cavities.push_back(*point);
  }
  return fit;
}

}  // namespace meniscus::mesh_tet
