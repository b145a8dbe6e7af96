#include "core/geometry/chambers.h"

#include <array>
#include <numeric>

#include <Eigen/Geometry>

#include "core/geometry/edge_uses.h"
#include "core/math/union_find.h"

namespace meniscus {

namespace {

// In no symmetry of likely surfaces.
const std::array<Vec3, 7> kDirections = {
    Vec3(0.812, 0.493, 0.3127),   Vec3(-0.371, 0.8613, 0.3471),
    Vec3(0.2317, -0.413, 0.8807), Vec3(-0.713, -0.5191, -0.4713),
    Vec3(0.5419, 0.1933, -0.817), Vec3(-0.1373, 0.6197, -0.7727),
    Vec3(0.657, -0.7417, -0.1321)};

/// The facets of each part, and which points belong to several parts.
class PartPoints {
 public:
  PartPoints(const SurfaceMesh& mesh, const Chambers& chambers)
      : mesh_(mesh),
        start_(chambers.parts + 1, 0),
        facets_(mesh.facets.size()),
        owner_(mesh.points.size(), -1) {
    for (const int part : chambers.part_of) {
      ++start_[part + 1];
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      const int part = chambers.part_of[f];
      facets_[next[part]++] = static_cast<int>(f);
      for (const int p : mesh.facets[f]) {
        owner_[p] = owner_[p] == -1 || owner_[p] == part ? part : -2;
      }
    }
  }

  /// The part's point farthest along the direction; -1 if others have it too.
  int outermost(int part, const Vec3& direction) const {
    int best = -1;
    double most = 0.0;
    for (int i = start_[part]; i < start_[part + 1]; ++i) {
      for (const int p : mesh_.facets[facets_[i]]) {
        const double at = direction.dot(mesh_.points[p]);
        if (best < 0 || at > most) {
          best = p;
          most = at;
        }
      }
    }
    return owner_[best] < 0 ? -1 : best;
  }

 private:
  const SurfaceMesh& mesh_;
  std::vector<int> start_;  // per part, into facets_
  std::vector<int> facets_;
  std::vector<int> owner_;  // per point: its part, -2: several
};

Surrounding surrounding_along(const SurfaceMesh& mesh, const Chambers& chambers,
                              const FacetTree& tree, int from,
                              const Vec3& direction, int part) {
  Surrounding seen;
  const auto hit =
      tree.first_hit(mesh.points[from], direction, chambers.part_of, part);
  if (hit) {
    const bool front = area_vector2(mesh, hit->facet).dot(direction) < 0.0;
    seen.facet = hit->facet;
    seen.body = body_of_side(mesh, 2 * hit->facet + (front ? 1 : 0));
  }
  return seen;
}

}  // namespace

Chambers find_chambers(const SurfaceMesh& mesh) {
  const int facets = static_cast<int>(mesh.facets.size());
  UnionFind sides(2 * mesh.facets.size());
  UnionFind parts(mesh.facets.size());
  for_each_edge(mesh, std::vector<char>(mesh.facets.size(), 1),
                [&](std::span<EdgeUse> uses) {
                  sort_around(mesh, uses);
                  for (std::size_t i = 0; i < uses.size(); ++i) {
                    const EdgeUse& next = uses[(i + 1) % uses.size()];
                    sides.join(uses[i].side_after(), next.side_before());
                    parts.join(uses[i].facet, next.facet);
                  }
                });
  Chambers chambers;
  int count = 0;
  chambers.part_of = parts.numbers(chambers.parts);
  chambers.shell_of = sides.numbers(count);
  chambers.shells.resize(count);
  for (int side = 0; side < 2 * facets; ++side) {
    const int f = side / 2;
    Shell& shell = chambers.shells[chambers.shell_of[side]];
    if (shell.facet < 0) {
      shell.facet = f;
      shell.body = body_of_side(mesh, side);
      shell.part = chambers.part_of[f];
    }
    const Vec3& origin = mesh.points[mesh.facets[shell.facet][0]];
    const Triangle& t = mesh.facets[f];
    const double volume = (mesh.points[t[0]] - origin)
                              .dot((mesh.points[t[1]] - origin)
                                       .cross(mesh.points[t[2]] - origin)) /
                          6.0;
    shell.volume += side % 2 == 0 ? volume : -volume;
  }
  return chambers;
}

std::vector<std::optional<Surrounding>> find_surroundings(
    const SurfaceMesh& mesh, const Chambers& chambers, const FacetTree& tree) {
  const PartPoints points(mesh, chambers);
  std::vector<std::optional<Surrounding>> result(chambers.parts);
  for (int part = 0; part < chambers.parts; ++part) {
    std::array<Surrounding, 3> seen;
    int votes = 0;
    for (const Vec3& direction : kDirections) {
      const int from = votes < 3 ? points.outermost(part, direction) : -1;
      if (from >= 0) {
        seen[votes++] =
            surrounding_along(mesh, chambers, tree, from, direction, part);
      }
    }
    if (votes > 0) {
      const bool agree = votes == 3 && seen[1].body == seen[2].body;
      result[part] = agree ? seen[1] : seen[0];
    }
  }
  return result;
}

}  // namespace meniscus
