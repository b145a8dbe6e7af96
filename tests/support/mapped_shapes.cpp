#include "tests/support/mapped_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/shapes.h"

namespace meniscus::shapes {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kShake = 0.2;  // of a cell

/// Numbers the lattice points (i, j) with i + j <= n of all layers.
class Lattice {
 public:
  Lattice(int n, int layers) : n_(n), layers_(layers) {}
  int id(int i, int j, int k) const {
    const int row = i * (n_ + 1) - i * (i - 1) / 2;  // points in rows before
    return k * ((n_ + 1) * (n_ + 2) / 2) + row + j;
  }
  Points points() const {
    Points x;
    for (int k = 0; k <= layers_; ++k) {
      for (int i = 0; i <= n_; ++i) {
        for (int j = 0; i + j <= n_; ++j) {
          x.emplace_back(static_cast<double>(i) / n_,
                         static_cast<double>(j) / n_,
                         static_cast<double>(k) / layers_);
        }
      }
    }
    return x;
  }

 private:
  int n_;
  int layers_;
};

/// Adds faces that lie where `value` is 0 at all three corners.
void add_faces(TetMesh& mesh) {
  constexpr std::array<std::array<int, 3>, 4> kFaces = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  constexpr double kOn = 1e-9;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (const auto& face : kFaces) {
      for (int label = 0; label < 5; ++label) {
        const bool on = std::all_of(face.begin(), face.end(), [&](int c) {
          const Vec3& x = mesh.nodes[ids[c]];
          const std::array<double, 5> value = {1.0 - x.x() - x.y(), x.x(),
                                               x.y(), x.z(), 1.0 - x.z()};
          return std::abs(value[label]) < kOn;
        });
        if (on) {
          for (const int c : face) {
            mesh.faces.push_back(ids[c]);
          }
          mesh.face_label.push_back(label);
          mesh.face_element.push_back(e);
        }
      }
    }
  }
}

void add_prism(TetMesh& mesh, std::array<int, 3> low, std::array<int, 3> high) {
  // Paths upward in the order of the ids: neighbours cut shared faces alike.
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return low[a] < low[b]; });
  for (int turn = 0; turn < 3; ++turn) {
    std::array<int, 4> tet;
    for (int k = 0; k < 4; ++k) {
      tet[k] = k <= turn ? low[order[k]] : high[order[k - 1]];
    }
    mesh.elements.insert(mesh.elements.end(), tet.begin(), tet.end());
    mesh.element_region.push_back(0);
    if (corner_volume(mesh, mesh.element_count() - 1) < 0.0) {
      std::swap(mesh.elements.end()[-1], mesh.elements.end()[-2]);
    }
  }
}

}  // namespace

TetMesh triangle_prism(int n, int layers) {
  const Lattice lattice(n, layers);
  TetMesh mesh;
  mesh.nodes = lattice.points();
  mesh.corner_count = static_cast<int>(mesh.nodes.size());
  mesh.labels = {"a0", "b0", "c0", "w0", "w1"};
  for (int k = 0; k < layers; ++k) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        const auto cell = [&](int di, int dj, int level) {
          return lattice.id(i + di, j + dj, k + level);
        };
        add_prism(mesh, {cell(0, 0, 0), cell(1, 0, 0), cell(0, 1, 0)},
                  {cell(0, 0, 1), cell(1, 0, 1), cell(0, 1, 1)});
        if (i + j + 1 < n) {
          add_prism(mesh, {cell(1, 0, 0), cell(0, 1, 0), cell(1, 1, 0)},
                    {cell(1, 0, 1), cell(0, 1, 1), cell(1, 1, 1)});
        }
      }
    }
  }
  add_faces(mesh);
  return mesh;
}

TetMesh mapped(TetMesh mesh, const std::function<Vec3(const Vec3&)>& map) {
  for (Vec3& x : mesh.nodes) {
    x = map(x);
  }
  return mesh;
}

TetMesh shaken(TetMesh mesh, double amount) {
  std::vector<char> boundary(mesh.nodes.size(), 0);
  for (const int node : mesh.faces) {
    boundary[node] = 1;
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (boundary[i] == 0) {
      const double k = static_cast<double>(i);
      mesh.nodes[i] +=
          amount * Vec3(std::sin(12.9898 * k), std::sin(78.233 * k + 1.0),
                        std::sin(37.719 * k + 2.0));
    }
  }
  return mesh;
}

TetMesh octant_shell(double inner, double outer, int n, int layers) {
  TetMesh mesh =
      mapped(straight_quadratic(shaken(triangle_prism(n, layers),
                                       kShake / std::max(n, layers))),
             [&](const Vec3& p) -> Vec3 {
               const Vec3 way(1.0 - p.x() - p.y(), p.x(), p.y());
               return inner * std::pow(outer / inner, p.z()) * way.normalized();
             });
  mesh.labels = {"x0", "y0", "z0", "inner", "outer"};
  return mesh;
}

TetMesh quarter_ring(double inner, double outer, double height, int nr, int nt,
                     int nz) {
  TetMesh mesh =
      mapped(straight_quadratic(shaken(brick({1.0, 1.0, 1.0}, nr, nt, nz),
                                       kShake / std::max({nr, nt, nz}))),
             [&](const Vec3& p) -> Vec3 {
               const double r = inner * std::pow(outer / inner, p.x());
               const double t = 0.5 * kPi * p.y();
               return {r * std::cos(t), r * std::sin(t), height * p.z()};
             });
  mesh.labels = {"inner", "outer", "y0", "x0", "z0", "z1"};
  return mesh;
}

}  // namespace meniscus::shapes
