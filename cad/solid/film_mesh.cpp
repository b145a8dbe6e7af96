#include "cad/solid/film_mesh.h"

#include <algorithm>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/math/dense.h"

namespace meniscus::solid {

namespace {

constexpr double kRounding = 1e-12;  // of cosines

std::vector<std::vector<int>> neighbours(const FilmMesh& mesh) {
  std::vector<std::vector<int>> rings(mesh.points.size());
  for (const Triangle& t : mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      rings[t[k]].push_back(t[(k + 1) % 3]);
      rings[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  for (std::vector<int>& ring : rings) {
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  }
  return rings;
}

std::vector<int> two_rings(const std::vector<std::vector<int>>& rings, int v) {
  std::vector<int> result = rings[v];
  for (const int w : rings[v]) {
    result.insert(result.end(), rings[w].begin(), rings[w].end());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  result.erase(std::remove(result.begin(), result.end(), v), result.end());
  return result;
}

/// z = a x + b y + c xx + d xy + e yy about `p` in a frame with z = `normal`;
/// weights fall with distance.
Vec3 fitted_normal(const FilmMesh& mesh, const Vec3& p, const Vec3& normal,
                   const std::vector<int>& near) {
  const Vec3 x = normal.unitOrthogonal();
  const Vec3 y = normal.cross(x);
  const int n = static_cast<int>(near.size());
  if (n < 7) {
    return normal;
  }
  double scale = 0.0;
  for (const int v : near) {
    scale = std::max(scale, (mesh.points[v] - p).norm());
  }
  Eigen::MatrixXd rows(n, 5);
  VectorX heights(n);
  for (int k = 0; k < n; ++k) {
    const Vec3 d = (mesh.points[near[k]] - p) / scale;
    const double a = d.dot(x);
    const double b = d.dot(y);
    const double weight = 1.0 / (0.1 + d.squaredNorm());
    rows.row(k) << a, b, a * a, a * b, b * b;
    rows.row(k) *= weight;
    heights[k] = weight * d.dot(normal);
  }
  const auto [c, rank] = least_squares(rows, heights);
  if (rank < 5) {
    return normal;
  }
  return (normal - c[0] * x - c[1] * y).normalized();
}

constexpr double kFold = 0.5;      // cosine between the facets of an edge
constexpr double kFlatter = 1e-6;  // what a flip has to gain

int corner_opposite(const Triangle& t, int a, int b) {
  return t[0] + t[1] + t[2] - a - b;
}

class FoldFlipper {
 public:
  explicit FoldFlipper(FilmMesh& mesh)
      : mesh_(mesh), owner_(facets_by_edge(mesh.facets)) {}

  /// Flips the edge if that makes its quadrangle flatter.
  bool flip(const Edge& edge) {
    const auto [a, b] = edge;
    const auto here = owner_.find(edge);
    const auto there = owner_.find({b, a});
    if (here == owner_.end() || there == owner_.end()) {
      return false;  // of a boundary, or flipped away
    }
    const int left = here->second;
    const int right = there->second;
    const Vec3 left_normal = normal_of(mesh_.facets[left]);
    const Vec3 right_normal = normal_of(mesh_.facets[right]);
    const double across = left_normal.dot(right_normal);
    if (across >= kFold) {
      return false;
    }
    const int c = corner_opposite(mesh_.facets[left], a, b);
    const int d = corner_opposite(mesh_.facets[right], a, b);
    if (owner_.count({c, d}) > 0 || owner_.count({d, c}) > 0) {
      return false;
    }
    const Triangle first{a, d, c};
    const Triangle second{d, b, c};
    const Vec3 first_normal = normal_of(first);
    const Vec3 second_normal = normal_of(second);
    const double before = std::min(
        {across, cosine(left_normal, {c, b}), cosine(left_normal, {a, c}),
         cosine(right_normal, {d, a}), cosine(right_normal, {b, d})});
    const double after =
        std::min({first_normal.dot(second_normal),
                  cosine(second_normal, {c, b}), cosine(first_normal, {a, c}),
                  cosine(first_normal, {d, a}), cosine(second_normal, {b, d})});
    if (after <= before + kFlatter) {
      return false;
    }
    mesh_.facets[left] = first;
    mesh_.facets[right] = second;
    owner_.erase(here);
    owner_.erase(there);
    for (const int f : {left, right}) {
      const Triangle& t = mesh_.facets[f];
      for (int k = 0; k < 3; ++k) {
        owner_[{t[k], t[(k + 1) % 3]}] = f;
      }
    }
    return true;
  }

 private:
  Vec3 normal_of(const Triangle& t) const {
    return (mesh_.points[t[1]] - mesh_.points[t[0]])
        .cross(mesh_.points[t[2]] - mesh_.points[t[0]])
        .normalized();
  }
  /// With the facet that has the directed edge; 1 on a boundary.
  double cosine(const Vec3& normal, const Edge& edge) const {
    const auto found = owner_.find(edge);
    return found == owner_.end()
               ? 1.0
               : normal.dot(normal_of(mesh_.facets[found->second]));
  }

  FilmMesh& mesh_;
  std::map<Edge, int> owner_;
};

}  // namespace

std::map<Edge, int> facets_by_edge(const std::vector<Triangle>& facets) {
  std::map<Edge, int> owner;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      owner[{facets[f][k], facets[f][(k + 1) % 3]}] = static_cast<int>(f);
    }
  }
  return owner;
}

void flip_folds(FilmMesh& mesh) {
  FoldFlipper flipper(mesh);
  bool any = true;
  for (std::size_t round = 0; any && round < mesh.facets.size(); ++round) {
    any = false;
    std::vector<Edge> edges;
    std::vector<Triangle> facet_edges;
    list_edges(mesh.facets, edges, facet_edges);
    for (const Edge& edge : edges) {
      any = flipper.flip(edge) || any;
    }
  }
}

void set_normals(FilmMesh& mesh) {
  Points flat_normals(mesh.points.size(), Vec3::Zero());
  std::vector<Points> around(mesh.points.size());  // of facets
  for (const Triangle& t : mesh.facets) {
    const Vec3 area = (mesh.points[t[1]] - mesh.points[t[0]])
                          .cross(mesh.points[t[2]] - mesh.points[t[0]]);
    for (const int v : t) {
      flat_normals[v] += area;
      around[v].push_back(area.normalized());
    }
  }
  const std::vector<std::vector<int>> rings = neighbours(mesh);
  // Facets of a smooth film turn farther, within a vertex's ring, than its
  // normal is from their mean: a fit beyond them extrapolates a crease.
  const auto least_cosine = [&](int v, const Vec3& flat_normal) {
    double least = 1.0;
    for (const int w : rings[v]) {
      for (const Vec3& normal : around[w]) {
        least = std::min(least, normal.dot(flat_normal));
      }
    }
    return least - kRounding;
  };
  mesh.normals.resize(mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Vec3 flat_normal = flat_normals[v].normalized();
    const std::vector<int> near = two_rings(rings, static_cast<int>(v));
    Vec3 normal = flat_normal;
    for (int round = 0; round < 2; ++round) {
      normal = fitted_normal(mesh, mesh.points[v], normal, near);
    }
    const bool within = normal.dot(flat_normal) >=
                        least_cosine(static_cast<int>(v), flat_normal);
    mesh.normals[v] = within ? normal : flat_normal;
  }
}

Vec3 smooth_point(const FilmMesh& mesh, int facet, const Vec3& at) {
  const Triangle& t = mesh.facets[facet];
  Vec3 flat_point = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    flat_point += at[k] * mesh.points[t[k]];
  }
  Vec3 result = flat_point;
  for (int k = 0; k < 3; ++k) {
    const Vec3& n = mesh.normals[t[k]];
    result += 0.5 * at[k] * n.dot(mesh.points[t[k]] - flat_point) * n;
  }
  if (!mesh.bulges.empty()) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      const auto found = mesh.bulges.find(edge_key(a, b));
      if (found != mesh.bulges.end()) {
        result += 4.0 * at[k] * at[(k + 1) % 3] * found->second;
      }
    }
  }
  return result;
}

Vec3 smooth_edge_point(const FilmMesh& mesh, int a, int b, double t) {
  const Vec3 flat_point = (1.0 - t) * mesh.points[a] + t * mesh.points[b];
  const Vec3& na = mesh.normals[a];
  const Vec3& nb = mesh.normals[b];
  return flat_point +
         0.5 * ((1.0 - t) * na.dot(mesh.points[a] - flat_point) * na +
                t * nb.dot(mesh.points[b] - flat_point) * nb);
}

Vec3 mixed_normal(const FilmMesh& mesh, int a, int b, double t) {
  return ((1.0 - t) * mesh.normals[a] + t * mesh.normals[b]).normalized();
}

std::vector<double> bulge_volumes(const SurfaceMesh& mesh,
                                  const std::vector<char>& flat) {
  std::vector<double> volumes(mesh.labels.size(), 0.0);
  for (std::size_t label = 0; label < mesh.labels.size(); ++label) {
    if (flat[label] != 0) {
      continue;
    }
    FilmMesh film;
    film.points = mesh.points;
    std::vector<int> facets;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      if (mesh.facet_label[f] == static_cast<int>(label)) {
        film.facets.push_back(mesh.facets[f]);
        facets.push_back(static_cast<int>(f));
      }
    }
    set_normals(film);
    for (std::size_t i = 0; i < facets.size(); ++i) {
      // Offsets are quadratic: the rule of the three mid-sides is exact.
      Vec3 offset = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        Vec3 at = Vec3::Constant(0.5);
        at[k] = 0.0;
        const Triangle& t = film.facets[i];
        offset +=
            smooth_point(film, static_cast<int>(i), at) -
            0.5 * (film.points[t[(k + 1) % 3]] + film.points[t[(k + 2) % 3]]);
      }
      volumes[label] += area_vector2(mesh, facets[i]).dot(offset) / 6.0;
    }
  }
  return volumes;
}

std::vector<std::vector<int>> boundary_loops(
    const std::vector<Triangle>& facets, const Points& points) {
  std::map<Edge, bool> directed;  // true: without its opposite
  for (const Triangle& t : facets) {
    for (int k = 0; k < 3; ++k) {
      const Edge edge{t[k], t[(k + 1) % 3]};
      const auto other = directed.find({edge[1], edge[0]});
      if (other != directed.end()) {
        directed.erase(other);
      } else if (!directed.emplace(edge, true).second) {
        throw MeshError(fmt::format(
            "more than two facets of one film meet at vertices {} and {}",
            edge[0], edge[1]));
      }
    }
  }
  std::map<int, int> next;
  for (const auto& [edge, open] : directed) {
    if (!next.emplace(edge[0], edge[1]).second) {
      const Vec3& p = points[static_cast<std::size_t>(edge[0])];
      throw MeshError(fmt::format(
          "a film's boundary touches itself at ({:.4g}, {:.4g}, {:.4g}), as "
          "where two of its lines end in one point: let them end apart, or "
          "write step-faceted",
          p.x(), p.y(), p.z()));
    }
  }
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int> loop;
    auto at = next.begin();
    while (at != next.end()) {
      loop.push_back(at->first);
      const int to = at->second;
      next.erase(at);
      at = next.find(to);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace meniscus::solid
