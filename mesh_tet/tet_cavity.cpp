#include "mesh_tet/tet_cavity.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace meniscus::mesh_tet {

namespace {

bool contains(const std::vector<int>& list, int value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

/// Nodes of the cavity's elements all lie on its boundary.
bool keeps_nodes(const TetEditor& tets, const Cavity& cavity) {
  std::vector<int> outer;
  for (const auto& face : cavity.faces) {
    outer.insert(outer.end(), face.begin(), face.end());
  }
  std::sort(outer.begin(), outer.end());
  return std::ranges::all_of(cavity.elements, [&](int e) {
    return std::ranges::all_of(tets.nodes(e), [&](int node) {
      return std::binary_search(outer.begin(), outer.end(), node);
    });
  });
}

}  // namespace

std::vector<Vec3> places_beside(const TetEditor& tets, int e) {
  const auto centroid = [&](int element) {
    Vec3 sum = Vec3::Zero();
    for (const int node : tets.nodes(element)) {
      sum += 0.25 * tets.point(node);
    }
    return sum;
  };
  std::vector<Vec3> places;
  const TetNodes ids = tets.nodes(e);
  Vec3 inward = Vec3::Zero();
  double size2 = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    const auto& f = kTetFaces[corner];
    const Vec3& a = tets.point(ids[f[0]]);
    const Vec3 u = tets.point(ids[f[1]]) - a;
    const Vec3 v = tets.point(ids[f[2]]) - a;
    size2 = std::max(size2, u.squaredNorm());
    const int other = tets.neighbour(e, corner);
    if (other >= 0) {
      places.push_back(centroid(other));
    } else {
      inward -= u.cross(v);
    }
  }
  if (inward.squaredNorm() > 0.0) {
    const Vec3 step = std::sqrt(size2) * inward.normalized();
    for (const double depth : {0.5, 0.35, 0.25, 0.15, 0.08}) {
      places.push_back(centroid(e) + depth * step);
    }
  }
  return places;
}

std::optional<Cavity> grow_cavity(const TetEditor& tets,
                                  std::span<const int> seeds, const Vec3& place,
                                  double floor, std::size_t most) {
  Cavity cavity;
  cavity.elements.assign(seeds.begin(), seeds.end());
  // A node at `place` is joined to all faces of the cavity [klingner2007]: the
  // cavity must be star-shaped about it, with elements better than `floor`.
  bool grown = true;
  while (grown) {
    grown = false;
    cavity.faces.clear();
    cavity.merit = 2.0;
    for (std::size_t i = 0; i < cavity.elements.size(); ++i) {
      const int e = cavity.elements[i];
      const TetNodes ids = tets.nodes(e);
      for (int corner = 0; corner < 4; ++corner) {
        const int other = tets.neighbour(e, corner);
        if (other >= 0 && contains(cavity.elements, other)) {
          continue;
        }
        const auto& f = kTetFaces[corner];
        const std::array<int, 3> face = {ids[f[0]], ids[f[1]], ids[f[2]]};
        // A face too poor to be joined gives way: the element behind it is
        // taken in. On the surface, or at `most` elements, there is none.
        const double merit =
            tet_merit({tets.point(face[0]), tets.point(face[2]),
                       tets.point(face[1]), place});
        if (merit > floor) {
          cavity.faces.push_back(face);
          cavity.merit = std::min(cavity.merit, merit);
        } else if (other < 0 || cavity.elements.size() >= most) {
          return std::nullopt;
        } else {
          cavity.elements.push_back(other);
          grown = true;
        }
      }
    }
  }
  // A node inside would be left without elements.
  if (!keeps_nodes(tets, cavity)) {
    return std::nullopt;
  }
  return cavity;
}

}  // namespace meniscus::mesh_tet
