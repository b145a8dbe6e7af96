#include "core/geometry/edge_uses.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"

namespace meniscus {

namespace {

/// Two unit vectors that make a right-handed frame with the edge.
std::array<Vec3, 2> axes_across(const Vec3& along) {
  int least = 0;
  along.cwiseAbs().minCoeff(&least);
  const Vec3 u = along.cross(Vec3::Unit(least)).normalized();
  return {u, along.cross(u)};
}

}  // namespace

void for_each_edge(const SurfaceMesh& mesh, const std::vector<char>& facets,
                   const std::function<void(std::span<EdgeUse>)>& visit) {
  const int count = static_cast<int>(mesh.facets.size());
  std::vector<std::size_t> start(mesh.points.size() + 1, 0);
  const auto for_each_use = [&](const auto& take) {
    for (int f = 0; f < count; ++f) {
      for (int k = 0; facets[f] != 0 && k < 3; ++k) {
        const int a = mesh.facets[f][k];
        const int b = mesh.facets[f][(k + 1) % 3];
        take(EdgeUse{edge_key(a, b), f, a < b});
      }
    }
  };
  for_each_use([&](const EdgeUse& use) { ++start[use.edge[0] + 1]; });
  for (std::size_t p = 1; p < start.size(); ++p) {
    start[p] += start[p - 1];
  }
  std::vector<EdgeUse> uses(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for_each_use([&](const EdgeUse& use) { uses[next[use.edge[0]]++] = use; });
  for (std::size_t p = 0; p + 1 < start.size(); ++p) {
    std::sort(uses.begin() + static_cast<std::ptrdiff_t>(start[p]),
              uses.begin() + static_cast<std::ptrdiff_t>(start[p + 1]),
              [](const EdgeUse& x, const EdgeUse& y) {
                return std::tie(x.edge[1], x.facet) <
                       std::tie(y.edge[1], y.facet);
              });
  }
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i;
    while (j < uses.size() && uses[j].edge == uses[i].edge) {
      ++j;
    }
    visit(std::span(uses).subspan(i, j - i));
    i = j;
  }
}

void sort_around(const SurfaceMesh& mesh, std::span<EdgeUse> uses) {
  if (uses.size() <= 2) {
    return;
  }
  const Vec3& from = mesh.points[uses[0].edge[0]];
  const Vec3 along = mesh.points[uses[0].edge[1]] - from;
  const auto axes = axes_across(along.normalized());
  const auto angle = [&](const EdgeUse& use) {
    const Triangle& t = mesh.facets[use.facet];
    const int apex = t[0] + t[1] + t[2] - use.edge[0] - use.edge[1];
    const Vec3 arm = mesh.points[apex] - from;
    return std::atan2(axes[1].dot(arm), axes[0].dot(arm));
  };
  std::sort(uses.begin(), uses.end(), [&](const EdgeUse& x, const EdgeUse& y) {
    return std::pair{angle(x), x.facet} < std::pair{angle(y), y.facet};
  });
}

}  // namespace meniscus
