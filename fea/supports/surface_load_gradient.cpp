#include "fea/supports/surface_load_gradient.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/face_points.h"
#include "fea/element/surface_faces.h"
#include "fea/loads/bearing_load.h"
#include "fea/loads/load_checks.h"
#include "fea/loads/loads.h"
#include "fea/loads/remote_gradient.h"
#include "fea/supports/springs.h"

namespace meniscus::supports {

namespace {

/// int v . traction dA with traction = total / area: by the rule of the
/// surface's weights.
void add_force(const TetMesh& mesh, const loads::SurfaceForce& load,
               const VectorX& v, Points& gradient) {
  const loads::SurfaceWeights w = loads::surface_weights(mesh, load.surfaces);
  const double area = w.weights.sum();
  double mean = 0.0;
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    mean += w.weights[static_cast<Eigen::Index>(k)] / area *
            load.total.dot(v.segment<3>(3L * w.nodes[k]));
  }
  for (const std::string& surface : load.surfaces) {
    element::pull_back_faces(
        mesh, element::surface_label(mesh, surface), element::FaceRule::Three,
        [&](int f,
            const element::FacePoint& point) -> element::FacePointGradient {
          const double here =
              load.total.dot(element::value_at(mesh, f, point, v));
          return {.by_normal =
                      (here - mean) / area * point.normal.normalized()};
        },
        gradient);
  }
}

void add_pressure(const TetMesh& mesh, const loads::LoadCase& load_case,
                  const loads::SurfacePressure& load, const VectorX& v,
                  Points& gradient) {
  const int label = element::surface_label(mesh, load.surface);
  if (!load.field) {
    element::pull_back_faces(
        mesh, label, element::FaceRule::Three,
        [&](int f,
            const element::FacePoint& point) -> element::FacePointGradient {
          return {.by_normal =
                      -load.pressure * element::value_at(mesh, f, point, v)};
        },
        gradient);
    return;
  }
  const std::string what =
      fmt::format("the pressure on surface '{}'", load.surface);
  loads::require_slope(load.slope, load_case, what);
  element::pull_back_faces(
      mesh, label, element::FaceRule::Seven,
      [&](int f,
          const element::FacePoint& point) -> element::FacePointGradient {
        const Vec3 here = element::value_at(mesh, f, point, v);
        const double p =
            loads::field_value(load.field, point.position, load_case, what);
        const Vec3 slope =
            loads::field_value(load.slope, point.position, load_case, what);
        return {-point.normal.dot(here) * slope, -p * here};
      },
      gradient);
}

void add_traction(const TetMesh& mesh, const loads::LoadCase& load_case,
                  const loads::SurfaceTraction& load, const VectorX& v,
                  Points& gradient) {
  const int label = element::surface_label(mesh, load.surface);
  if (!load.field) {
    element::pull_back_faces(
        mesh, label, element::FaceRule::Three,
        [&](int f,
            const element::FacePoint& point) -> element::FacePointGradient {
          return {.by_normal =
                      load.traction.dot(element::value_at(mesh, f, point, v)) *
                      point.normal.normalized()};
        },
        gradient);
    return;
  }
  const std::string what =
      fmt::format("the traction on surface '{}'", load.surface);
  loads::require_slope(load.slope, load_case, what);
  element::pull_back_faces(
      mesh, label, element::FaceRule::Seven,
      [&](int f,
          const element::FacePoint& point) -> element::FacePointGradient {
        const Vec3 here = element::value_at(mesh, f, point, v);
        const Vec3 t =
            loads::field_value(load.field, point.position, load_case, what);
        const Mat3 slope =
            loads::field_value(load.slope, point.position, load_case, what);
        const double area = point.normal.norm();
        return {area * slope.transpose() * here,
                t.dot(here) / area * point.normal};
      },
      gradient);
}

/// Of area (v . k u) + normal (n . v)(n . u), n the point's normal.
void add_bed_gradient(const TetMesh& mesh, const loads::SpringBed& bed,
                      const VectorX& u, const VectorX& v, Points& gradient) {
  const BedStiffness bed_stiffness = bed_stiffness_of(mesh, bed);
  const int label = element::surface_label(mesh, bed.surface);
  double product = 0.0;
  element::pull_back_faces(
      mesh, label, element::FaceRule::Seven,
      [&](int f,
          const element::FacePoint& point) -> element::FacePointGradient {
        const Vec3 at_u = element::value_at(mesh, f, point, u);
        const Vec3 at_v = element::value_at(mesh, f, point, v);
        const double area = point.normal.norm();
        const Vec3 n = point.normal / area;
        const double along = n.dot(at_u) * n.dot(at_v);
        const double plain = at_v.dot(bed_stiffness.tensor * at_u);
        product += area * (plain + bed_stiffness.normal * along);
        return {.by_normal = -plain * n - bed_stiffness.normal *
                                              (n.dot(at_u) * at_v +
                                               n.dot(at_v) * at_u - along * n)};
      },
      gradient);
  if (bed.measure == loads::SpringMeasure::Total) {
    const double area = loads::surface_weights(mesh, bed.surface).weights.sum();
    element::pull_back_faces(
        mesh, label, element::FaceRule::Three,
        [&](int,
            const element::FacePoint& point) -> element::FacePointGradient {
          return {.by_normal = product / area * point.normal.normalized()};
        },
        gradient);
  }
}

}  // namespace

void add_surface_load_gradient(const TetMesh& mesh,
                               const loads::LoadCase& load_case,
                               const VectorX& v, Points& gradient) {
  for (const loads::SurfaceForce& load : load_case.forces) {
    add_force(mesh, load, v, gradient);
  }
  for (const loads::SurfacePressure& load : load_case.pressures) {
    add_pressure(mesh, load_case, load, v, gradient);
  }
  for (const loads::SurfaceTraction& load : load_case.tractions) {
    add_traction(mesh, load_case, load, v, gradient);
  }
  for (const loads::RemoteLoad& load : load_case.remote_loads) {
    loads::remote_gradient(mesh, load, v, &gradient);
  }
  for (const loads::BearingLoad& load : load_case.bearings) {
    loads::bearing_gradient(mesh, load, v, &gradient);
  }
}

void add_spring_gradient(const TetMesh& mesh, const loads::LoadCase& load_case,
                         const VectorX& u, const VectorX& v, Points& gradient) {
  for (const loads::SpringBed& bed : load_case.springs) {
    add_bed_gradient(mesh, bed, u, v, gradient);
  }
}

}  // namespace meniscus::supports
