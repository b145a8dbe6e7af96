#include "mesh_tet/surface_fit.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace meniscus {

namespace {

/// Component number per facet, in order of first facet.
std::vector<int> components(const SurfaceMesh& surface, int& count) {
  std::vector<int> parent(surface.points.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int p) {
    while (parent[p] != p) {
      parent[p] = parent[parent[p]];
      p = parent[p];
    }
    return p;
  };
  for (const Triangle& t : surface.facets) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  std::vector<int> number(surface.points.size(), -1);
  std::vector<int> result;
  count = 0;
  for (const Triangle& t : surface.facets) {
    int& n = number[root(t[0])];
    if (n < 0) {
      n = count++;
    }
    result.push_back(n);
  }
  return result;
}

Vec3 centroid(const SurfaceMesh& surface, int facet) {
  const Triangle& t = surface.facets[facet];
  return (surface.points[t[0]] + surface.points[t[1]] + surface.points[t[2]]) /
         3.0;
}

/// Distance along `direction` at which the ray meets the facet.
std::optional<double> meet(const SurfaceMesh& surface, int facet,
                           const Vec3& origin, const Vec3& direction) {
  const Triangle& t = surface.facets[facet];
  const Vec3 a = surface.points[t[0]] - origin;
  const Vec3 b = surface.points[t[1]] - origin;
  const Vec3 c = surface.points[t[2]] - origin;
  const double u = direction.dot(b.cross(c));
  const double v = direction.dot(c.cross(a));
  const double w = direction.dot(a.cross(b));
  const bool inside =
      (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
  if (!inside || u + v + w == 0.0) {
    return std::nullopt;
  }
  return (u * a + v * b + w * c).dot(direction) / (u + v + w);
}

/// Half way from a facet's outer side to what it looks at: inside the cavity
/// that it bounds. Of a few facets, the one with the most room.
std::optional<Vec3> point_in_cavity(const SurfaceMesh& surface,
                                    const std::vector<int>& facets) {
  constexpr std::size_t kTries = 16;
  const std::size_t step = std::max<std::size_t>(1, facets.size() / kTries);
  double most = 0.0;
  std::optional<Vec3> best;
  for (std::size_t i = 0; i < facets.size(); i += step) {
    const Vec3 normal = area_vector2(surface, facets[i]);
    if (!(normal.norm() > 0.0)) {
      continue;
    }
    const Vec3 direction = normal.normalized();
    const Vec3 origin = centroid(surface, facets[i]);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
      if (static_cast<int>(f) != facets[i]) {
        const auto at = meet(surface, static_cast<int>(f), origin, direction);
        if (at && *at > 0.0) {
          nearest = std::min(nearest, *at);
        }
      }
    }
    if (std::isfinite(nearest) && nearest > most) {
      most = nearest;
      best = origin + 0.5 * nearest * direction;
    }
  }
  return best;
}

/// Signed turns of a surface around a point, from the facets' solid angles
/// (Van Oosterom and Strackee 1983): 1 inside, 0 outside.
double winding(const SurfaceMesh& surface, const std::vector<int>& of_facet,
               int component, const Vec3& point) {
  double angle = 0.0;
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    if (of_facet[f] == component) {
      continue;
    }
    const Triangle& t = surface.facets[f];
    const Vec3 a = surface.points[t[0]] - point;
    const Vec3 b = surface.points[t[1]] - point;
    const Vec3 c = surface.points[t[2]] - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle +=
        2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc +
                                                b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4.0 * M_PI);
}

}  // namespace

SurfaceFit fit_surface(const SurfaceMesh& surface) {
  SurfaceFit fit;
  int count = 0;
  const std::vector<int> of_facet = components(surface, count);
  std::vector<std::vector<int>> facets(count);
  for (std::size_t f = 0; f < of_facet.size(); ++f) {
    facets[of_facet[f]].push_back(static_cast<int>(f));
  }
  const Vec3 origin =
      surface.points.empty() ? Vec3::Zero() : surface.points.front();
  for (int c = 0; c < count; ++c) {
    double volume = 0.0;
    for (const int f : facets[c]) {
      const Triangle& t = surface.facets[f];
      volume += (surface.points[t[0]] - origin)
                    .dot((surface.points[t[1]] - origin)
                             .cross(surface.points[t[2]] - origin)) /
                6.0;
    }
    fit.volume += volume;
    const Vec3 at = centroid(surface, facets[c].front());
    // Every component must lie inside an outer one if it is a cavity, and
    // outside all others if it is solid.
    const long around =
        count == 1 ? 0 : std::lround(winding(surface, of_facet, c, at));
    const bool cavity = volume < 0.0;
    if (around != (cavity ? 1 : 0)) {
      fit.problem = fmt::format(
          "the closed component {} of {} (around facet {} at ({:.6g}, {:.6g}, "
          "{:.6g})) is {}; turn its facets round",
          c, count, facets[c].front(), at.x(), at.y(), at.z(),
          cavity ? "inside out and in no other one"
                 : "a second solid inside another one");
      return fit;
    }
    if (cavity) {
      const auto point = point_in_cavity(surface, facets[c]);
      if (!point) {
        fit.problem = fmt::format(
            "the cavity around facet {} has no room inside", facets[c].front());
        return fit;
      }
      fit.cavities.push_back(*point);
    }
  }
  return fit;
}

}  // namespace meniscus
