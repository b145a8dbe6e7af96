#include "fea/loads/loads.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/face_points.h"
#include "fea/element/surface_faces.h"
#include "fea/loads/bearing_load.h"
#include "fea/loads/body_loads.h"
#include "fea/loads/load_checks.h"
#include "fea/loads/remote_load.h"

namespace meniscus::loads {

namespace {

std::string named(const char* what, const Surfaces& surfaces) {
  return fmt::format("the {} on surface '{}'", what, surfaces.text());
}

/// Adds traction(point) [force per area, times the point's area] to f.
template <class Traction>
void spread(const TetMesh& mesh, const std::string& surface,
            element::FaceRule rule, const Traction& traction, VectorX& f) {
  surface_weights(mesh, surface);  // refuses a surface without area
  element::over_face_points(mesh, element::surface_label(mesh, surface), rule,
                            [&](int face, const element::FacePoint& point) {
                              const Vec3 force = traction(point);
                              const auto ids = mesh.face(face);
                              for (std::size_t a = 0; a < ids.size(); ++a) {
                                f.segment<3>(3L * ids[a]) +=
                                    point.shape[a] * force;
                              }
                            });
}

void add_force(const TetMesh& mesh, const LoadCase& load_case,
               const SurfaceForce& load, VectorX& f) {
  require_finite(load.total, load_case, named("force", load.surfaces));
  const SurfaceWeights w = surface_weights(mesh, load.surfaces);
  const Vec3 traction = load.total / w.weights.sum();
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    f.segment<3>(3L * w.nodes[k]) +=
        w.weights[static_cast<Eigen::Index>(k)] * traction;
  }
}

void add_pressure(const TetMesh& mesh, const LoadCase& load_case,
                  const SurfacePressure& load, VectorX& f) {
  const std::string what = named("pressure", load.surface);
  if (!load.field) {
    require_finite(load.pressure, load_case, what);
    return spread(
        mesh, load.surface, element::FaceRule::Three,
        [&](const element::FacePoint& point) -> Vec3 {
          return -load.pressure * point.normal;
        },
        f);
  }
  spread(
      mesh, load.surface, element::FaceRule::Seven,
      [&](const element::FacePoint& point) -> Vec3 {
        return -field_value(load.field, point.position, load_case, what) *
               point.normal;
      },
      f);
}

void add_traction(const TetMesh& mesh, const LoadCase& load_case,
                  const SurfaceTraction& load, VectorX& f) {
  const std::string what = named("traction", load.surface);
  if (!load.field) {
    require_finite(load.traction, load_case, what);
    return spread(
        mesh, load.surface, element::FaceRule::Three,
        [&](const element::FacePoint& point) -> Vec3 {
          return point.normal.norm() * load.traction;
        },
        f);
  }
  spread(
      mesh, load.surface, element::FaceRule::Seven,
      [&](const element::FacePoint& point) -> Vec3 {
        return point.normal.norm() *
               field_value(load.field, point.position, load_case, what);
      },
      f);
}

void add_remote(const TetMesh& mesh, const LoadCase& load_case,
                const RemoteLoad& load, VectorX& f) {
  require_finite(load.force, load_case, named("remote force", load.surfaces));
  require_finite(load.moment, load_case, named("moment", load.surfaces));
  require_finite(load.point, load_case,
                 named("point of the remote load", load.surfaces));
  const SurfaceWeights w = surface_weights(mesh, load.surfaces);
  const Points forces = remote_forces(mesh, w, load);
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    f.segment<3>(3L * w.nodes[k]) += forces[k];
  }
}

}  // namespace

SurfaceWeights surface_weights(const TetMesh& mesh, const Surfaces& surfaces) {
  SurfaceWeights result;
  VectorX all = VectorX::Zero(static_cast<Eigen::Index>(mesh.nodes.size()));
  for (const std::string& surface : surfaces) {
    const int label = element::surface_label(mesh, surface);
    const std::vector<int> nodes = element::surface_nodes(mesh, label);
    result.nodes.insert(result.nodes.end(), nodes.begin(), nodes.end());
    element::over_face_points(mesh, label, element::FaceRule::Three,
                              [&](int face, const element::FacePoint& point) {
                                const double area = point.normal.norm();
                                const auto ids = mesh.face(face);
                                for (std::size_t a = 0; a < ids.size(); ++a) {
                                  all[ids[a]] += point.shape[a] * area;
                                }
                              });
  }
  std::sort(result.nodes.begin(), result.nodes.end());
  result.nodes.erase(std::unique(result.nodes.begin(), result.nodes.end()),
                     result.nodes.end());
  result.weights.resize(static_cast<Eigen::Index>(result.nodes.size()));
  for (std::size_t k = 0; k < result.nodes.size(); ++k) {
    result.weights[static_cast<Eigen::Index>(k)] = all[result.nodes[k]];
  }
  if (!(result.weights.sum() > 0.0)) {
    throw InvalidInput(fmt::format(
        "surface '{}' has {} nodes but an area of {}", surfaces.text(),
        result.nodes.size(), result.weights.sum()));
  }
  return result;
}

VectorX nodal_forces(const TetMesh& mesh, const LoadCase& load_case,
                     const std::vector<element::Material>& materials) {
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
  for (const SurfaceForce& load : load_case.forces) {
    add_force(mesh, load_case, load, f);
  }
  for (const SurfacePressure& load : load_case.pressures) {
    add_pressure(mesh, load_case, load, f);
  }
  for (const SurfaceTraction& load : load_case.tractions) {
    add_traction(mesh, load_case, load, f);
  }
  for (const RemoteLoad& load : load_case.remote_loads) {
    add_remote(mesh, load_case, load, f);
  }
  for (const BearingLoad& load : load_case.bearings) {
    add_bearing_forces(mesh, load, f);
  }
  add_body_forces(mesh, load_case, materials, f);
  add_thermal_forces(mesh, load_case, materials, f);
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

}  // namespace meniscus::loads
