#include "evolve/walls/wall_sectors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"
#include "core/math/union_find.h"

namespace meniscus::walls {

namespace {

class Finder {
 public:
  explicit Finder(const SurfaceMesh& mesh)
      : mesh_(mesh), x_(mesh.points), corners_(6 * mesh.facets.size()) {}

  Sectors find() {
    find_edges();
    join_sides();
    Sectors result;
    result.of_corner = corners_.roots();
    for (const auto& [edge, facets] : edges_) {
      if (facets.size() == 1) {
        result.rims.push_back(facets[0]);
      }
    }
    return result;
  }

 private:
  const Triangle& facet(int f) const { return mesh_.facets[f]; }

  void find_edges() {
    for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
      const Triangle& t = facet(f);
      for (int k = 0; k < 3; ++k) {
        const int a = t[k];
        const int b = t[(k + 1) % 3];
        edges_[edge_key(a, b)].push_back({f, k});
      }
    }
  }

  // Corners of sides: (2 facet + side) * 3 + corner; side 0 is the front.
  static int corner_id(int facet, int side, int corner) {
    return (2 * facet + side) * 3 + corner;
  }

  // Sides that face each other across the edge, at both of its ends.
  void join_across(const Edge& edge, const Incidence& f, int side_f,
                   const Incidence& g, int side_g) {
    for (const int v : edge) {
      corners_.join(corner_id(f.facet, side_f, corner_at(f, v)),
                    corner_id(g.facet, side_g, corner_at(g, v)));
    }
  }

  int corner_at(const Incidence& at, int v) const {
    return facet(at.facet)[at.corner] == v ? at.corner : (at.corner + 1) % 3;
  }

  bool runs_forward(const Edge& edge, const Incidence& at) const {
    return facet(at.facet)[at.corner] == edge[0];
  }

  // Facets counter-clockwise about the edge, seen against its direction.
  std::vector<Incidence> about(const Edge& edge,
                               const std::vector<Incidence>& facets) const {
    const Vec3 along = (x_[edge[1]] - x_[edge[0]]).normalized();
    const auto inward = [&](const Incidence& at) {
      const Vec3 way = x_[facet(at.facet)[(at.corner + 2) % 3]] - x_[edge[0]];
      return Vec3(way - along * along.dot(way));
    };
    const Vec3 first = inward(facets[0]).normalized();
    const Vec3 second = along.cross(first);
    std::vector<std::pair<double, Incidence>> sorted;
    for (const Incidence& at : facets) {
      const Vec3 way = inward(at);
      double angle = std::atan2(second.dot(way), first.dot(way));
      if (at.facet == facets[0].facet) {
        angle = 0.0;
      } else if (angle < 0.0) {
        angle += 2.0 * EIGEN_PI;
      }
      sorted.emplace_back(angle, at);
    }
    std::stable_sort(
        sorted.begin(), sorted.end(),
        [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Incidence> result;
    result.reserve(sorted.size());
    for (const auto& [angle, at] : sorted) {
      result.push_back(at);
    }
    return result;
  }

  void join_sides() {
    for (const auto& [edge, facets] : edges_) {
      if (facets.size() == 2) {
        const bool same =
            runs_forward(edge, facets[0]) != runs_forward(edge, facets[1]);
        for (const int side : {0, 1}) {
          join_across(edge, facets[0], side, facets[1], same ? side : 1 - side);
        }
      } else if (facets.size() > 2) {
        const std::vector<Incidence> round = about(edge, facets);
        for (std::size_t k = 0; k < round.size(); ++k) {
          const Incidence& f = round[k];
          const Incidence& g = round[(k + 1) % round.size()];
          // A facet that runs along the edge has its normal, the edge's
          // direction x its own, on the side of growing angles.
          join_across(edge, f, runs_forward(edge, f) ? 0 : 1, g,
                      runs_forward(edge, g) ? 1 : 0);
        }
      }
    }
  }

  const SurfaceMesh& mesh_;
  const Points& x_;
  std::map<Edge, std::vector<Incidence>> edges_;
  UnionFind corners_;
};

}  // namespace

Sectors find_sectors(const SurfaceMesh& mesh) { return Finder(mesh).find(); }

}  // namespace meniscus::walls
