#include "tests/support/shapes.h"

#include <cmath>
#include <map>

#include "core/geometry/edge_key.h"

namespace meniscus::shapes {

namespace {

constexpr std::array<const char*, 6> kBoxLabels = {"x0", "x1", "y0",
                                                   "y1", "z0", "z1"};

}  // namespace

SurfaceMesh box(const Vec3& size, int n) {
  SurfaceMesh mesh;
  mesh.labels.assign(kBoxLabels.begin(), kBoxLabels.end());
  std::map<std::array<int, 3>, int> ids;
  const auto id_of = [&](const std::array<int, 3>& at) {
    const auto [found, added] =
        ids.emplace(at, static_cast<int>(mesh.points.size()));
    if (added) {
      mesh.points.emplace_back(size.x() * at[0] / n, size.y() * at[1] / n,
                               size.z() * at[2] / n);
    }
    return found->second;
  };
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const bool high = face % 2 == 1;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto corner = [&](int a, int b) {
          std::array<int, 3> at{};
          at[axis] = high ? n : 0;
          at[u] = i + a;
          at[v] = j + b;
          return id_of(at);
        };
        const int p = corner(0, 0);
        const int q = corner(1, 0);
        const int r = corner(1, 1);
        const int s = corner(0, 1);
        const auto add = [&](int a, int b, int c) {
          mesh.facets.push_back(high ? Triangle{a, b, c} : Triangle{a, c, b});
          mesh.facet_label.push_back(face);
        };
        add(p, q, r);
        add(p, r, s);
      }
    }
  }
  return mesh;
}

SurfaceMesh cubes(const std::array<int, 3>& count, int n,
                  const std::function<int(int, int, int)>& body_at) {
  SurfaceMesh mesh;
  mesh.labels = {"outside", "inside"};
  std::map<std::array<int, 3>, int> ids;
  const auto id_of = [&](const std::array<int, 3>& at) {
    const auto [found, added] =
        ids.emplace(at, static_cast<int>(mesh.points.size()));
    if (added) {
      mesh.points.push_back(Vec3(at[0], at[1], at[2]) / n);
    }
    return found->second;
  };
  const auto body = [&](const std::array<int, 3>& cube) {
    for (int k = 0; k < 3; ++k) {
      if (cube[k] < 0 || cube[k] >= count[k]) {
        return -1;
      }
    }
    return body_at(cube[0], cube[1], cube[2]);
  };
  // The face of cube `low` towards `axis`, its normal along the axis if `up`.
  const auto add_face = [&](const std::array<int, 3>& low, int axis, bool up,
                            const FacetBodies& bodies) {
    for (int square = 0; square < n * n; ++square) {
      std::array<int, 4> p{};
      for (int k = 0; k < 4; ++k) {
        std::array<int, 3> at = {low[0] * n, low[1] * n, low[2] * n};
        at[axis] += n;
        at[(axis + 1) % 3] += square % n + (k == 1 || k == 2 ? 1 : 0);
        at[(axis + 2) % 3] += square / n + (k >= 2 ? 1 : 0);
        p[k] = id_of(at);
      }
      for (const Triangle& t :
           {Triangle{p[0], p[1], p[2]}, Triangle{p[0], p[2], p[3]}}) {
        mesh.facets.push_back(up ? t : Triangle{t[0], t[2], t[1]});
        mesh.facet_label.push_back(bodies.front < 0 ? 0 : 1);
        mesh.facet_bodies.push_back(bodies);
      }
    }
  };
  for (int i = -1; i < count[0]; ++i) {
    for (int j = -1; j < count[1]; ++j) {
      for (int k = -1; k < count[2]; ++k) {
        for (int axis = 0; axis < 3; ++axis) {
          const std::array<int, 3> low = {i, j, k};
          std::array<int, 3> high = low;
          ++high[axis];
          const int a = body(low);
          const int b = body(high);
          const bool up = b < 0 || (a >= 0 && a < b);
          if (a != b) {
            add_face(low, axis, up, up ? FacetBodies{a, b} : FacetBodies{b, a});
          }
        }
      }
    }
  }
  return mesh;
}

SurfaceMesh sphere(double radius, int levels) {
  SurfaceMesh mesh;
  mesh.labels = {"sphere"};
  const double g = (1.0 + std::sqrt(5.0)) / 2.0;
  for (const Vec3& p :
       {Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0),
        Vec3(0, -1, g), Vec3(0, 1, g), Vec3(0, -1, -g), Vec3(0, 1, -g),
        Vec3(g, 0, -1), Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)}) {
    mesh.points.push_back(radius * p.normalized());
  }
  mesh.facets = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::vector<Edge> edges;
    std::vector<Triangle> facet_edges;
    list_edges(mesh.facets, edges, facet_edges);
    const int first = static_cast<int>(mesh.points.size());
    for (const Edge& e : edges) {
      mesh.points.push_back(
          radius * (mesh.points[e[0]] + mesh.points[e[1]]).normalized());
    }
    std::vector<Triangle> finer;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      const Triangle& t = mesh.facets[f];
      const int a = first + facet_edges[f][0];
      const int b = first + facet_edges[f][1];
      const int c = first + facet_edges[f][2];
      finer.push_back({t[0], a, c});
      finer.push_back({a, t[1], b});
      finer.push_back({c, b, t[2]});
      finer.push_back({a, b, c});
    }
    mesh.facets = std::move(finer);
  }
  mesh.facet_label.assign(mesh.facets.size(), 0);
  return mesh;
}

TetMesh brick(const Vec3& size, int nx, int ny, int nz) {
  TetMesh mesh;
  const std::array<int, 3> n = {nx, ny, nz};
  const auto id = [&](int i, int j, int k) {
    return (k * (ny + 1) + j) * (nx + 1) + i;
  };
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        mesh.nodes.emplace_back(size.x() * i / nx, size.y() * j / ny,
                                size.z() * k / nz);
      }
    }
  }
  mesh.corner_count = static_cast<int>(mesh.nodes.size());
  // Kuhn's cut: one tetrahedron per order of the axes, all along one diagonal.
  constexpr std::array<std::array<int, 3>, 6> kOrders = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  mesh.labels.assign(kBoxLabels.begin(), kBoxLabels.end());
  constexpr std::array<std::array<int, 3>, 4> kFaces = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        for (const auto& order : kOrders) {
          std::array<std::array<int, 3>, 4> at;
          at[0] = {i, j, k};
          for (int s = 0; s < 3; ++s) {
            at[s + 1] = at[s];
            ++at[s + 1][order[s]];
          }
          const bool even = (order[1] - order[0] + 3) % 3 == 1;
          if (!even) {
            std::swap(at[1], at[2]);
          }
          const int element = mesh.element_count();
          for (const auto& c : at) {
            mesh.elements.push_back(id(c[0], c[1], c[2]));
          }
          mesh.element_region.push_back(0);
          for (const auto& face : kFaces) {
            for (int axis = 0; axis < 3; ++axis) {
              for (const int side : {0, n[axis]}) {
                const bool on =
                    std::all_of(face.begin(), face.end(),
                                [&](int v) { return at[v][axis] == side; });
                if (on) {
                  for (const int v : face) {
                    mesh.faces.push_back(id(at[v][0], at[v][1], at[v][2]));
                  }
                  mesh.face_label.push_back(2 * axis + (side == 0 ? 0 : 1));
                  mesh.face_element.push_back(element);
                }
              }
            }
          }
        }
      }
    }
  }
  return mesh;
}

TetMesh straight_quadratic(const TetMesh& linear) {
  TetMesh mesh;
  mesh.order = 2;
  mesh.nodes = linear.nodes;
  mesh.corner_count = linear.corner_count;
  mesh.element_region = linear.element_region;
  mesh.face_label = linear.face_label;
  mesh.face_front = linear.face_front;
  mesh.face_element = linear.face_element;
  mesh.labels = linear.labels;
  std::map<Edge, int> ids;
  const auto middle = [&](int a, int b) {
    const Edge key = edge_key(a, b);
    const auto [at, added] =
        ids.emplace(key, static_cast<int>(mesh.nodes.size()));
    if (added) {
      mesh.nodes.push_back(0.5 * (linear.nodes[a] + linear.nodes[b]));
    }
    return at->second;
  };
  for (int e = 0; e < linear.element_count(); ++e) {
    const auto ids4 = linear.element(e);
    mesh.elements.insert(mesh.elements.end(), ids4.begin(), ids4.end());
    for (const Edge& edge : kTetEdges) {
      mesh.elements.push_back(middle(ids4[edge[0]], ids4[edge[1]]));
    }
  }
  for (int f = 0; f < linear.face_count(); ++f) {
    const auto ids3 = linear.face(f);
    mesh.faces.insert(mesh.faces.end(), ids3.begin(), ids3.end());
    for (int k = 0; k < 3; ++k) {
      mesh.faces.push_back(middle(ids3[k], ids3[(k + 1) % 3]));
    }
  }
  return mesh;
}

TetMesh sheared(const TetMesh& mesh, double amount) {
  TetMesh moved = mesh;
  for (Vec3& p : moved.nodes) {
    p += amount * Vec3(0.3 * p.y() + 0.1 * p.z(), -0.2 * p.z() + 0.05 * p.x(),
                       0.25 * p.x());
  }
  return moved;
}

}  // namespace meniscus::shapes
