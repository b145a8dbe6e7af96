#include "fea/loads.h"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "fea/surface_faces.h"

namespace meniscus {

namespace {

constexpr int kFacePoints = 3;

/// Shape functions and their derivatives at one point of a face.
struct FacePoint {
  std::array<double, 6> shape{};
  std::array<std::array<double, 2>, 6> slope{};
};

/// Points (1/6, 1/6, 2/3) and their turns, weight 1/6 each: exact to degree 2.
FacePoint face_point(int order, int q) {
  std::array<double, 3> L = {1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0};
  L[q] = 2.0 / 3.0;
  constexpr double kSlope[3][2] = {{-1.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}};
  FacePoint point;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    point.shape[a] = order == 1 ? L[a] : L[a] * (2.0 * L[a] - 1.0);
    point.shape[3 + a] = 4.0 * L[a] * L[b];
    for (int k = 0; k < 2; ++k) {
      point.slope[a][k] = kSlope[a][k] * (order == 1 ? 1.0 : 4.0 * L[a] - 1.0);
      point.slope[3 + a][k] = 4.0 * (kSlope[a][k] * L[b] + kSlope[b][k] * L[a]);
    }
  }
  return point;
}

/// Calls visit(node, integral of N over the face, integral of N times the
/// outward normal) for every face of the label and every node of the face.
template <class Visit>
void for_face_nodes(const TetMesh& mesh, int label, const Visit& visit) {
  std::array<FacePoint, kFacePoints> points;
  for (int q = 0; q < kFacePoints; ++q) {
    points[q] = face_point(mesh.order, q);
  }
  const int count = mesh.nodes_per_face();
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[f] != label) {
      continue;
    }
    const auto ids = mesh.face(f);
    std::array<double, 6> area{};
    std::array<Vec3, 6> normal;
    normal.fill(Vec3::Zero());
    for (const FacePoint& point : points) {
      Vec3 u = Vec3::Zero();
      Vec3 v = Vec3::Zero();
      for (int a = 0; a < count; ++a) {
        u += point.slope[a][0] * mesh.nodes[ids[a]];
        v += point.slope[a][1] * mesh.nodes[ids[a]];
      }
      const Vec3 n = u.cross(v) / 6.0;
      const double dA = n.norm();
      for (int a = 0; a < count; ++a) {
        area[a] += point.shape[a] * dA;
        normal[a] += point.shape[a] * n;
      }
    }
    for (int a = 0; a < count; ++a) {
      visit(ids[a], area[a], normal[a]);
    }
  }
}

void check_finite(bool finite, const LoadCase& load_case,
                  const std::string& surface) {
  if (!finite) {
    throw InvalidInput(
        fmt::format("load case '{}': the load on surface '{}' is not a finite "
                    "number",
                    load_case.name, surface));
  }
}

}  // namespace

SurfaceWeights surface_weights(const TetMesh& mesh,
                               const std::string& surface) {
  const int label = surface_label(mesh, surface);
  SurfaceWeights result;
  result.nodes = surface_nodes(mesh, label);
  VectorX all = VectorX::Zero(static_cast<Eigen::Index>(mesh.nodes.size()));
  for_face_nodes(mesh, label, [&](int node, double area, const Vec3&) {
    all[node] += area;
  });
  result.weights.resize(static_cast<Eigen::Index>(result.nodes.size()));
  for (std::size_t k = 0; k < result.nodes.size(); ++k) {
    result.weights[static_cast<Eigen::Index>(k)] = all[result.nodes[k]];
  }
  if (!(result.weights.sum() > 0.0)) {
    throw InvalidInput(
        fmt::format("surface '{}' has {} nodes but an area of {}", surface,
                    result.nodes.size(), result.weights.sum()));
  }
  return result;
}

VectorX nodal_forces(const TetMesh& mesh, const LoadCase& load_case) {
  VectorX f = VectorX::Zero(static_cast<Eigen::Index>(3 * mesh.nodes.size()));
  if (load_case.nodal.size() != 0) {
    if (load_case.nodal.size() != f.size() || !load_case.nodal.allFinite()) {
      throw InvalidInput(fmt::format(
          "load case '{}': its {} nodal forces must be finite and 3 "
          "for each of {} nodes",
          load_case.name, load_case.nodal.size(), mesh.nodes.size()));
    }
    f = load_case.nodal;
  }
  for (const SurfaceForce& force : load_case.forces) {
    check_finite(force.total.allFinite(), load_case, force.surface);
    const SurfaceWeights w = surface_weights(mesh, force.surface);
    const Vec3 traction = force.total / w.weights.sum();
    for (std::size_t k = 0; k < w.nodes.size(); ++k) {
      f.segment<3>(3L * w.nodes[k]) +=
          w.weights[static_cast<Eigen::Index>(k)] * traction;
    }
  }
  for (const SurfacePressure& load : load_case.pressures) {
    check_finite(std::isfinite(load.pressure), load_case, load.surface);
    surface_weights(mesh, load.surface);  // refuses a surface without area
    for_face_nodes(mesh, surface_label(mesh, load.surface),
                   [&](int node, double, const Vec3& normal) {
                     f.segment<3>(3L * node) -= load.pressure * normal;
                   });
  }
  return f;
}

double mean_displacement(const TetMesh& mesh, const std::string& surface,
                         const Vec3& direction, const VectorX& displacement) {
  const double length = direction.norm();
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw InvalidInput(fmt::format(
        "mean displacement of surface '{}': direction ({}, {}, {}) has no "
        "length",
        surface, direction.x(), direction.y(), direction.z()));
  }
  if (displacement.size() != static_cast<Eigen::Index>(3 * mesh.nodes.size())) {
    throw InvalidInput(fmt::format(
        "mean displacement of surface '{}': {} displacements for {} nodes",
        surface, displacement.size(), mesh.nodes.size()));
  }
  const SurfaceWeights w = surface_weights(mesh, surface);
  double sum = 0.0;
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    sum += w.weights[static_cast<Eigen::Index>(k)] *
           displacement.segment<3>(3L * w.nodes[k]).dot(direction);
  }
  return sum / (w.weights.sum() * length);
}

}  // namespace meniscus
