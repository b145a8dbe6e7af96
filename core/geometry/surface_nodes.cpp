#include "core/geometry/surface_nodes.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"

namespace meniscus {

namespace {

int middle_of(const EdgeMiddles& middles, int a, int b) {
  const auto at = middles.find(edge_key(a, b));
  return at == middles.end() ? -1 : at->second;
}

/// Edges to halve: of the marked facets, and all three of a facet that has two.
std::vector<char> halved_edges(const SurfaceNodes& nodes,
                               const std::vector<char>& marked) {
  std::vector<char> halved(nodes.edges.size(), 0);
  const auto halve = [&](const Triangle& edges) {
    for (const int e : edges) {
      halved[static_cast<std::size_t>(e)] = 1;
    }
  };
  for (std::size_t f = 0; f < marked.size(); ++f) {
    if (marked[f] != 0) {
      halve(nodes.facet_edges[f]);
    }
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (const Triangle& edges : nodes.facet_edges) {
      const auto count = std::count_if(edges.begin(), edges.end(), [&](int e) {
        return halved[static_cast<std::size_t>(e)] != 0;
      });
      if (count == 2) {
        halve(edges);
        changed = true;
      }
    }
  }
  return halved;
}

/// Corners, then middles (01) (12) (20).
using SixNodes = std::array<Vec3, 6>;

/// The least normal area of a six-node triangle at its nodes over that of the
/// flat one.
double least_area_ratio(const SixNodes& x) {
  const Vec3 flat = (x[1] - x[0]).cross(x[2] - x[0]);
  double least = 1.0;
  for (int node = 0; node < 6; ++node) {
    Vec3 l = Vec3::Zero();
    if (node < 3) {
      l[node] = 1.0;
    } else {
      l[node - 3] = 0.5;
      l[(node - 2) % 3] = 0.5;
    }
    std::array<Vec3, 3> by;  // by each barycentric coordinate
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      const int last = (i + 2) % 3;
      by[i] = (4.0 * l[i] - 1.0) * x[i] + 4.0 * l[next] * x[3 + i] +
              4.0 * l[last] * x[3 + last];
    }
    const Vec3 area = (by[1] - by[0]).cross(by[2] - by[0]);
    least = std::min(least, area.dot(flat) / flat.squaredNorm());
  }
  return least;
}

/// Splits facets one by one into a new surface.
class Splitter {
 public:
  Splitter(const SurfaceNodes& nodes, const std::vector<char>& marked,
           const EdgeMiddles& middles)
      : nodes_(nodes),
        middles_(middles),
        corner_(nodes.corner),
        middle_corner_(nodes.edges.size(), -1) {
    const std::vector<char> halved = halved_edges(nodes, marked);
    for (std::size_t e = 0; e < halved.size(); ++e) {
      if (halved[e] != 0) {
        middle_corner_[e] = static_cast<int>(corner_.size());
        corner_.push_back(middle(nodes.edges[e][0], nodes.edges[e][1]));
      }
    }
    mesh_.labels = nodes.mesh.labels;
  }

  SurfaceNodes split(const std::vector<char>& straight) && {
    for (std::size_t f = 0; f < nodes_.mesh.facets.size(); ++f) {
      split_facet(f);
    }
    return surface_nodes(std::move(mesh_), std::move(corner_), new_middles_,
                         straight);
  }

 private:
  /// The point between two old corners.
  int middle(int a, int b) const {
    const int m = middle_of(middles_, corner_[static_cast<std::size_t>(a)],
                            corner_[static_cast<std::size_t>(b)]);
    if (m < 0) {
      throw MeshError(fmt::format(
          "the surface's edge between corners {} and {} cannot be halved: the "
          "film has no vertex there; refine it once more",
          a, b));
    }
    return m;
  }

  void add(std::size_t parent, const Triangle& facet) {
    mesh_.facets.push_back(facet);
    mesh_.facet_label.push_back(nodes_.mesh.facet_label[parent]);
    if (!nodes_.mesh.facet_bodies.empty()) {
      mesh_.facet_bodies.push_back(nodes_.mesh.facet_bodies[parent]);
    }
  }

  void split_facet(std::size_t f) {
    const Triangle& t = nodes_.mesh.facets[f];
    Triangle m;  // corners on the edges (01), (12), (20)
    int count = 0;
    int last = 0;
    for (int k = 0; k < 3; ++k) {
      const int e = nodes_.facet_edges[f][static_cast<std::size_t>(k)];
      m[static_cast<std::size_t>(k)] =
          middle_corner_[static_cast<std::size_t>(e)];
      if (m[static_cast<std::size_t>(k)] >= 0) {
        ++count;
        last = k;
      }
    }
    if (count == 0) {
      add(f, t);
    } else if (count == 3) {
      add(f, {t[0], m[0], m[2]});
      add(f, {m[0], t[1], m[1]});
      add(f, {m[2], m[1], t[2]});
      add(f, {m[0], m[1], m[2]});
    } else {
      const auto k = static_cast<std::size_t>(last);
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      const int c = t[(k + 2) % 3];
      add(f, {a, m[k], c});
      add(f, {m[k], b, c});
      add_median(a, b, c, m[k]);
    }
    for (int k = 0; k < 3; ++k) {
      keep_middles(t[static_cast<std::size_t>(k)],
                   t[static_cast<std::size_t>((k + 1) % 3)]);
    }
    if (count == 3) {
      keep_middles(m[0], m[1]);
      keep_middles(m[1], m[2]);
      keep_middles(m[2], m[0]);
    }
  }

  /// The middles of an edge and of its halves go on as they are.
  void keep_middles(int a, int b) {
    const int pa = corner_[static_cast<std::size_t>(a)];
    const int pb = corner_[static_cast<std::size_t>(b)];
    const int m = middle_of(middles_, pa, pb);
    if (m < 0) {
      return;
    }
    new_middles_[edge_key(pa, pb)] = m;
    for (const int end : {pa, pb}) {
      if (const int half = middle_of(middles_, end, m); half >= 0) {
        new_middles_[edge_key(end, m)] = half;
      }
    }
  }

  /// Half way from c to the middle of ab stands, one level down, the middle of
  /// the line between the other two middles.
  void add_median(int a, int b, int c, int on_ab) {
    const int m = middle_of(middles_, middle(b, c), middle(c, a));
    if (m >= 0) {
      new_middles_[edge_key(corner_[static_cast<std::size_t>(c)],
                            corner_[static_cast<std::size_t>(on_ab)])] = m;
    }
  }

  const SurfaceNodes& nodes_;
  const EdgeMiddles& middles_;
  std::vector<int> corner_;
  std::vector<int> middle_corner_;  // per old edge, -1: whole
  EdgeMiddles new_middles_;         // of the new surface's edges
  SurfaceMesh mesh_;
};

}  // namespace

QuadraticSurface SurfaceNodes::at(const Points& points) const {
  QuadraticSurface result{
      .base = mesh, .edges = edges, .mid = {}, .facet_edges = facet_edges};
  result.base.points.reserve(corner.size());
  for (const int p : corner) {
    result.base.points.push_back(points[static_cast<std::size_t>(p)]);
  }
  const Points& x = result.base.points;
  result.mid.reserve(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    result.mid.push_back(
        mid[e] >= 0 ? points[static_cast<std::size_t>(mid[e])]
                    : Vec3(0.5 * (x[static_cast<std::size_t>(edges[e][0])] +
                                  x[static_cast<std::size_t>(edges[e][1])])));
  }
  return result;
}

Points SurfaceNodes::transpose(const Points& by_corners,
                               const Points& by_mid_sides,
                               std::size_t points) const {
  if (by_corners.size() != corner.size() || by_mid_sides.size() != mid.size()) {
    throw MeshError(fmt::format(
        "a surface of {} corners and {} mid-sides has a gradient by {} and {}",
        corner.size(), mid.size(), by_corners.size(), by_mid_sides.size()));
  }
  Points result(points, Vec3::Zero());
  for (std::size_t c = 0; c < corner.size(); ++c) {
    result[static_cast<std::size_t>(corner[c])] += by_corners[c];
  }
  for (std::size_t e = 0; e < mid.size(); ++e) {
    if (mid[e] >= 0) {
      result[static_cast<std::size_t>(mid[e])] += by_mid_sides[e];
      continue;
    }
    for (const int end : edges[e]) {
      const int p = corner[static_cast<std::size_t>(end)];
      result[static_cast<std::size_t>(p)] += 0.5 * by_mid_sides[e];
    }
  }
  return result;
}

SurfaceNodes surface_nodes(SurfaceMesh mesh, std::vector<int> corner,
                           const EdgeMiddles& middles,
                           const std::vector<char>& straight) {
  SurfaceNodes nodes{.mesh = std::move(mesh), .corner = std::move(corner)};
  list_edges(nodes.mesh.facets, nodes.edges, nodes.facet_edges);
  nodes.mid.reserve(nodes.edges.size());
  for (const Edge& e : nodes.edges) {
    const int m =
        middle_of(middles, nodes.corner[static_cast<std::size_t>(e[0])],
                  nodes.corner[static_cast<std::size_t>(e[1])]);
    const bool curved = m >= 0 && straight[static_cast<std::size_t>(m)] == 0;
    nodes.mid.push_back(curved ? m : -1);
  }
  return nodes;
}

int straighten_folded(SurfaceNodes& nodes, const Points& points) {
  constexpr double kLeastArea = 0.2;
  int count = 0;
  for (bool changed = true; changed;) {  // neighbors may fold for it
    changed = false;
    const QuadraticSurface surface = nodes.at(points);
    for (std::size_t f = 0; f < nodes.mesh.facets.size(); ++f) {
      SixNodes x;
      for (int k = 0; k < 3; ++k) {
        x[k] = surface.base.points[nodes.mesh.facets[f][k]];
        x[3 + k] = surface.mid[nodes.facet_edges[f][k]];
      }
      if (least_area_ratio(x) >= kLeastArea) {
        continue;
      }
      for (const int e : nodes.facet_edges[f]) {
        changed = changed || nodes.mid[e] >= 0;
        count += nodes.mid[e] >= 0 ? 1 : 0;
        nodes.mid[e] = -1;
      }
    }
  }
  return count;
}

SurfaceNodes split_facets(const SurfaceNodes& nodes,
                          const std::vector<char>& marked,
                          const EdgeMiddles& middles,
                          const std::vector<char>& straight) {
  if (marked.size() != nodes.mesh.facets.size()) {
    throw MeshError(fmt::format("split_facets: {} marks for {} facets",
                                marked.size(), nodes.mesh.facets.size()));
  }
  return Splitter(nodes, marked, middles).split(straight);
}

}  // namespace meniscus
