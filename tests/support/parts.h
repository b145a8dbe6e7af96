/// Small models that the elasticity tests share.
#pragma once

#include <cmath>

#include "fea/elastic/elasticity.h"
#include "fea/solver/assembly.h"
#include "tests/support/shapes.h"

namespace meniscus::parts {

inline element::Material steel() {
  return {"steel", 210000.0, 0.3, 7.8e-9, {}};
}

inline loads::Support hold(const std::string& surface) {
  return {surface, true, true, true};
}

inline loads::LoadCase pulled(const Vec3& force) {
  loads::LoadCase load_case;
  load_case.name = "main";
  load_case.supports = {hold("x0")};
  load_case.forces = {{"x1", force}};
  return load_case;
}

/// Four-node brick with its inner nodes displaced irregularly.
inline TetMesh distorted_brick(const Vec3& size, int n) {
  TetMesh mesh = shapes::brick(size, n, n, n);
  for (Vec3& x : mesh.nodes) {
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      inside = inside && x[k] > 1e-9 && x[k] < size[k] - 1e-9;
    }
    if (inside) {
      const Vec3 s = 17.0 * x.cwiseQuotient(size);
      x += 0.12 / n *
           Vec3(std::sin(s.x() + 2.0 * s.y()), std::cos(3.0 * s.y() + s.z()),
                std::sin(5.0 * s.z() - s.x()))
               .cwiseProduct(size);
    }
  }
  return mesh;
}

/// The mesh's stiffness in its own numbering.
inline solver::ElementTable table_of(const TetMesh& mesh) {
  return solver::make_element_table(
      solver::one_chunk(static_cast<int>(mesh.nodes.size())),
      mesh.nodes_per_element(), mesh.elements, mesh.element_region);
}

/// K u by the solver's product.
inline VectorX product(const solver::ElementTable& table,
                       const solver::BlockMatrix<double>& matrix,
                       const VectorX& u) {
  Eigen::Matrix4Xd x = Eigen::Matrix4Xd::Zero(4, table.pattern.nodes);
  x.topRows<3>() = u.reshaped(3, table.pattern.nodes);
  Eigen::Matrix4Xd y = x;
  solver::multiply<3, 1>(table.pattern, matrix, x.data(), y.data());
  return Eigen::Matrix3Xd(y.topRows<3>()).reshaped();
}

/// A quarter of a thick cylinder, 1 <= r <= 2, of the given height, n cells
/// along the radius: surfaces x0 (bore), x1 (outside), y0 (plane y = 0), y1
/// (plane x = 0), z0, z1. Ten-node elements are curved.
inline TetMesh quarter_tube(int n, double height) {
  constexpr double kPi = 3.14159265358979323846;
  TetMesh mesh = shapes::straight_quadratic(
      shapes::brick({1.0, 0.5 * kPi, height}, n, 2 * n, 1));
  for (Vec3& x : mesh.nodes) {
    const double r = 1.0 + x.x();
    x = Vec3(r * std::cos(x.y()), r * std::sin(x.y()), x.z());
  }
  return mesh;
}

inline loads::LoadCase tube_pressure(double pressure) {
  loads::LoadCase load_case;
  load_case.name = "bore";
  load_case.supports = {{"y0", false, true, false},
                        {"y1", true, false, false},
                        {"z0", false, false, true},
                        {"z1", false, false, true}};
  load_case.pressures = {{"x0", pressure}};
  return load_case;
}

}  // namespace meniscus::parts
