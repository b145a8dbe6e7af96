#include "core/geometry/touching_bodies.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/chambers.h"
#include "core/geometry/facet_tree.h"

namespace meniscus {

namespace {

/// Corners in an order of their own, and whether that turns the facet around.
std::pair<Triangle, bool> sorted_corners(const Triangle& facet) {
  Triangle sorted = facet;
  std::sort(sorted.begin(), sorted.end());
  const auto least = std::min_element(facet.begin(), facet.end());
  const auto at = static_cast<std::size_t>(least - facet.begin());
  return {sorted, facet[(at + 1) % 3] > facet[(at + 2) % 3]};
}

/// Without the second of two that look at each other.
SurfaceMesh with_common_facets(const SurfaceMesh& surface) {
  struct Seen {
    bool turned = false;
    bool paired = false;
  };
  std::map<Triangle, Seen> seen;
  SurfaceMesh result{.points = surface.points,
                     .facets = {},
                     .facet_label = {},
                     .labels = surface.labels};
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const auto [corners, turned] = sorted_corners(surface.facets[f]);
    const auto [at, is_new] = seen.try_emplace(corners, Seen{turned});
    if (!is_new && at->second.turned != turned && !at->second.paired) {
      at->second.paired = true;
      continue;
    }
    result.facets.push_back(surface.facets[f]);
    result.facet_label.push_back(surface.facet_label[f]);
  }
  return result;
}

/// The body in each chamber, by its shells; -1: none. Nothing where the facets
/// do not say.
std::optional<std::vector<int>> bodies_of_shells(const SurfaceMesh& surface,
                                                 const Chambers& chambers,
                                                 int& count) {
  std::vector<char> is_material(chambers.shells.size(), 0);
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    is_material[static_cast<std::size_t>(chambers.shell_of[2 * f])] = 1;
  }
  std::vector<int> body(chambers.shells.size(), -1);
  bool has_cavities = false;
  for (std::size_t s = 0; s < body.size(); ++s) {
    if (is_material[s] != 0 && chambers.shells[s].volume > 0.0) {
      body[s] = count++;
    }
    has_cavities = has_cavities || (is_material[s] != 0 && body[s] < 0);
  }
  if (!has_cavities || count < 2) {
    return body;
  }
  // A cavity's wall belongs to what it floats in.
  SurfaceMesh known = surface;
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    known.facet_bodies.push_back(
        {body[static_cast<std::size_t>(chambers.shell_of[2 * f])],
         body[static_cast<std::size_t>(chambers.shell_of[2 * f + 1])]});
  }
  std::vector<int> all(known.facets.size());
  std::iota(all.begin(), all.end(), 0);
  const auto around = find_surroundings(known, chambers, FacetTree(known, all));
  for (std::size_t s = 0; s < body.size(); ++s) {
    if (is_material[s] != 0 && body[s] < 0) {
      const auto& seen =
          around[static_cast<std::size_t>(chambers.shells[s].part)];
      if (!seen || seen->body < 0) {
        return std::nullopt;
      }
      body[s] = seen->body;
    }
  }
  return body;
}

}  // namespace

SurfaceMesh with_own_bodies(SurfaceMesh surface) {
  surface.facet_bodies.clear();
  const auto is_flat = [](const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  };
  if (std::ranges::any_of(surface.facets, is_flat)) {
    return surface;
  }
  SurfaceMesh result = with_common_facets(surface);
  const Chambers chambers = find_chambers(result);
  int count = 0;
  const auto body = bodies_of_shells(result, chambers, count);
  if (!body || count < 2) {
    return surface;
  }
  for (std::size_t f = 0; f < result.facets.size(); ++f) {
    const FacetBodies bodies = {
        (*body)[static_cast<std::size_t>(chambers.shell_of[2 * f])],
        (*body)[static_cast<std::size_t>(chambers.shell_of[2 * f + 1])]};
    if (bodies.behind < 0 || bodies.behind == bodies.front) {
      return surface;
    }
    result.facet_bodies.push_back(bodies);
  }
  return result;
}

}  // namespace meniscus
