#include "mesh_tet/mesh_motion.h"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/linear_solve.h"
#include "mesh_tet/tet_quality.h"

namespace meniscus::mesh_tet {

namespace {

using Table = Eigen::Matrix<double, Eigen::Dynamic, 3>;  // one row per node

/// One row each.
Table rows_of(const Points& points) {
  Table rows(points.size(), 3);
  for (std::size_t n = 0; n < points.size(); ++n) {
    rows.row(static_cast<Eigen::Index>(n)) = points[n].transpose();
  }
  return rows;
}

struct Stiffness {
  SparseMatrix inner;   // K_ii, lower triangle
  SparseMatrix across;  // K_is: rows inner nodes, columns surface points
};

/// Of the Laplacian with conductivity mean volume / volume.
Stiffness assemble(const TetMesh& mesh, int surface_points) {
  const int inner = static_cast<int>(mesh.nodes.size()) - surface_points;
  std::vector<Eigen::Triplet<double>> lower;
  std::vector<Eigen::Triplet<double>> across;
  lower.reserve(10 * static_cast<std::size_t>(mesh.element_count()));
  // Conductivity c_e = mean volume / V_e: small elements move as if stiff.
  double mean_volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    mean_volume += corner_volume(mesh, e) / mesh.element_count();
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    const TetCorners x = {mesh.nodes[ids[0]], mesh.nodes[ids[1]],
                          mesh.nodes[ids[2]], mesh.nodes[ids[3]]};
    const double volume = tet_volume(x);
    if (!(volume > 0.0)) {
      throw MeshError(fmt::format(
          "mesh motion: reference element {} has volume {:.6g}", e, volume));
    }
    // Constant gradients of linear shape functions, by the opposite faces.
    std::array<Vec3, 4> area;  // gradient of shape function i: -area_i / 3 V
    for (int i = 0; i < 4; ++i) {
      const auto& c = kTetFaces[i];
      area[i] = 0.5 * (x[c[1]] - x[c[0]]).cross(x[c[2]] - x[c[0]]);
    }
    // K_ij = c_e V grad N_i . grad N_j.
    const double weight = mean_volume / (9.0 * volume * volume);
    // Rows of inner nodes only: shifts d solve K_ii d_i = -K_is d_s.
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const int row = ids[i] - surface_points;
        const int column = ids[j] - surface_points;
        const double value = weight * area[i].dot(area[j]);
        if (row >= 0 && column >= 0 && row >= column) {
          lower.emplace_back(row, column, value);
        } else if (row >= 0 && column < 0) {
          across.emplace_back(row, ids[j], value);
        }
      }
    }
  }
  Stiffness stiffness{SparseMatrix(inner, inner),
                      SparseMatrix(inner, surface_points)};
  stiffness.inner.setFromTriplets(lower.begin(), lower.end());
  stiffness.across.setFromTriplets(across.begin(), across.end());
  return stiffness;
}

}  // namespace

struct MeshMotion::Impl {
  Points reference;
  int surface = 0;
  SparseMatrix coupling;  // K_is: rows inner nodes, columns surface points
  std::unique_ptr<SymmetricFactor> inner;  // K_ii; none without inner nodes
};

MeshMotion::MeshMotion(const TetMesh& mesh, int surface_points)
    : impl_(std::make_unique<Impl>()) {
  const int nodes = static_cast<int>(mesh.nodes.size());
  if (mesh.order != 1 || surface_points < 0 || surface_points > nodes) {
    throw MeshError(fmt::format(
        "mesh motion needs a four-node mesh with its surface points first; "
        "found order {}, {} nodes, {} surface points",
        mesh.order, nodes, surface_points));
  }
  impl_->reference = mesh.nodes;
  impl_->surface = surface_points;
  Stiffness stiffness = assemble(mesh, surface_points);
  impl_->coupling.swap(stiffness.across);
  if (nodes == surface_points) {
    return;
  }
  impl_->inner =
      std::make_unique<SymmetricFactor>(stiffness.inner, FactorKind::Cholesky);
  if (!impl_->inner->factorize(stiffness.inner)) {
    throw MeshError(fmt::format(
        "mesh motion: node {} cannot be tied to the surface; is it part of "
        "any element?",
        surface_points + impl_->inner->failed_column()));
  }
}

MeshMotion::~MeshMotion() = default;
MeshMotion::MeshMotion(MeshMotion&&) noexcept = default;
MeshMotion& MeshMotion::operator=(MeshMotion&&) noexcept = default;

Points MeshMotion::move(const Points& surface) const {
  if (surface.size() != static_cast<std::size_t>(impl_->surface)) {
    throw MeshError(fmt::format("mesh motion: {} surface points instead of {}",
                                surface.size(), impl_->surface));
  }
  Points nodes = impl_->reference;
  Points shift(surface.size());
  for (std::size_t n = 0; n < surface.size(); ++n) {
    shift[n] = surface[n] - impl_->reference[n];
    nodes[n] = surface[n];
  }
  if (impl_->inner) {
    const Eigen::MatrixXd right = -(impl_->coupling * rows_of(shift));
    const Eigen::MatrixXd inner = impl_->inner->solve(right);
    for (Eigen::Index i = 0; i < inner.rows(); ++i) {
      nodes[impl_->surface + i] += inner.row(i).transpose();
    }
  }
  return nodes;
}

Points MeshMotion::transpose(const Points& node_gradient) const {
  if (node_gradient.size() != impl_->reference.size()) {
    throw MeshError(fmt::format("mesh motion: {} gradients for {} nodes",
                                node_gradient.size(), impl_->reference.size()));
  }
  Points surface(node_gradient.begin(), node_gradient.begin() + impl_->surface);
  if (impl_->inner) {
    const Points inner(node_gradient.begin() + impl_->surface,
                       node_gradient.end());
    const Eigen::MatrixXd solved = impl_->inner->solve(rows_of(inner));
    const Eigen::MatrixXd back = impl_->coupling.transpose() * solved;
    for (int n = 0; n < impl_->surface; ++n) {
      surface[n] -= back.row(n).transpose();
    }
  }
  return surface;
}

}  // namespace meniscus::mesh_tet
