#include <Eigen/Geometry>

#include "fea/element/face_points.h"
#include "fea/element/surface_faces.h"
#include "fea/loads/bearing_load.h"
#include "fea/loads/loads.h"

namespace meniscus::loads {

namespace {

/// With N the area vector of a point, z its height and Y = s + z t, v . f is
/// the sum of e = (N . Y)(N . W) / |N| over points with N . Y < 0, W the part
/// of v across the axis; s and t follow from the balance, whose multipliers
/// u_s, u_t take U = u_s + z u_t off W.
struct BearingSum {
  const BearingPressure& pressure;
  Vec3 s, t, u_s, u_t;

  struct Terms {
    double z, a, b, size;  // of N . Y and N . W
    Vec3 Y, U, W;
  };
  Terms terms(const element::FacePoint& point, const Vec3& v) const {
    Terms at;
    at.z = pressure.height(point.position);
    at.Y = s + at.z * t;
    at.U = u_s + at.z * u_t;
    at.W = pressure.across(v) - at.U;
    at.a = point.normal.dot(at.Y);
    at.b = point.normal.dot(at.W);
    at.size = point.normal.norm();
    return at;
  }
  /// de / dz.
  double by_height(const element::FacePoint& point, const Terms& at) const {
    return (point.normal.dot(t) * at.b - at.a * point.normal.dot(u_t)) /
           at.size;
  }
  element::FacePointGradient by_point(const element::FacePoint& point,
                                      const Terms& at) const {
    const Vec3& N = point.normal;
    return {by_height(point, at) * pressure.axis(),
            (at.b * at.Y + at.a * at.W) / at.size -
                at.a * at.b / (at.size * at.size * at.size) * N};
  }
  /// Vectors across the axis turn with it; r: from the point.
  Vec3 by_axis(const element::FacePoint& point, const Terms& at, const Vec3& v,
               const Vec3& r) const {
    const Vec3& N = point.normal;
    const Vec3& axis = pressure.axis();
    const double along = N.dot(axis);
    const Vec3 by_a = -along * at.Y + N.dot(t) * r;
    const Vec3 by_b = -axis.dot(v) * N - along * (v - at.U) - N.dot(u_t) * r;
    return (by_a * at.b + at.a * by_b) / at.size;
  }
};

template <class Visit>
void over_pressed(const TetMesh& mesh, const BearingLoad& load,
                  const BearingPressure& pressure, const Visit& visit) {
  for (const std::string& surface : load.surfaces) {
    element::over_face_points(mesh, element::surface_label(mesh, surface),
                              element::FaceRule::Seven,
                              [&](int face, const element::FacePoint& point) {
                                if (pressure.pressed(point) > 0.0) {
                                  visit(face, point);
                                }
                              });
  }
}

/// The places of what is pressed, of the even part and of a fitted axis.
void pull_back(const TetMesh& mesh, const BearingLoad& load,
               const BearingSum& sum, const VectorX& v, const Vec3& by_axis,
               Points& gradient) {
  const BearingPressure& pressure = sum.pressure;
  const Vec3& axis = pressure.axis();
  const bool fitted = pressure.axis_is_fitted();
  const Mat3 B = fitted ? pressure.by_normals(by_axis) : Mat3::Zero();
  const SurfaceWeights w = surface_weights(mesh, load.surfaces);
  const double area = w.weights.sum();
  double mean = 0.0;
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    mean += w.weights[static_cast<Eigen::Index>(k)] / area *
            axis.dot(v.segment<3>(3L * w.nodes[k]));
  }
  for (const std::string& surface : load.surfaces) {
    const int label = element::surface_label(mesh, surface);
    element::pull_back_faces(
        mesh, label, element::FaceRule::Seven,
        [&](int face, const element::FacePoint& point) {
          element::FacePointGradient by;
          if (pressure.pressed(point) > 0.0) {
            by = sum.by_point(
                point,
                sum.terms(point, element::value_at(mesh, face, point, v)));
          }
          const Vec3& N = point.normal;
          const double size = N.norm();
          const Vec3 BN = B * N;
          by.by_normal +=
              2.0 / size * BN - N.dot(BN) / (size * size * size) * N;
          return by;
        },
        gradient);
    element::pull_back_faces(
        mesh, label, element::FaceRule::Three,
        [&](int face,
            const element::FacePoint& point) -> element::FacePointGradient {
          const double here = axis.dot(element::value_at(mesh, face, point, v));
          return {.by_normal = axis.dot(load.force) * (here - mean) / area *
                               point.normal.normalized()};
        },
        gradient);
  }
}

Vec3 mean_of(const TetMesh& mesh, const BearingLoad& load, const VectorX& v) {
  const SurfaceWeights w = surface_weights(mesh, load.surfaces);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    sum +=
        w.weights[static_cast<Eigen::Index>(k)] * v.segment<3>(3L * w.nodes[k]);
  }
  return sum / w.weights.sum();
}

}  // namespace

BearingGradient bearing_gradient(const TetMesh& mesh, const BearingLoad& load,
                                 const VectorX& v, Points* gradient) {
  const BearingPressure pressure(mesh, load);
  const Vec3& axis = pressure.axis();
  const Vec3 mean = mean_of(mesh, load, v);
  BearingGradient result{.value = axis.dot(load.force) * axis.dot(mean)};
  Eigen::Vector4d work = Eigen::Vector4d::Zero();
  over_pressed(mesh, load, pressure,
               [&](int face, const element::FacePoint& point) {
                 const Vec3 here = element::value_at(mesh, face, point, v);
                 result.value += pressure.force_at(point).dot(here);
                 work -= pressure.across(point.normal).dot(here) /
                         point.normal.norm() * pressure.shape(point);
               });
  const auto [u_s, u_t] = pressure.adjoint(work);
  const BearingSum sum{pressure, pressure.s(), pressure.t(), u_s, u_t};
  Vec3 by_axis = -axis.dot(load.force) * u_s + axis.dot(mean) * load.force +
                 axis.dot(load.force) * mean;
  double by_height = 0.0;
  over_pressed(
      mesh, load, pressure, [&](int face, const element::FacePoint& point) {
        const Vec3 here = element::value_at(mesh, face, point, v);
        const BearingSum::Terms at = sum.terms(point, here);
        by_axis +=
            sum.by_axis(point, at, here, point.position - value_of(load.point));
        by_height += sum.by_height(point, at);
      });
  by_axis = pressure.across(by_axis);
  if (gradient != nullptr) {
    pull_back(mesh, load, sum, v, by_axis, *gradient);
  }
  result.by_force = u_s + axis.dot(mean) * axis;
  if (load.point) {
    result.by_point = -by_height * axis;
  }
  if (load.axis) {
    result.by_axis = by_axis / load.axis->norm();
  }
  return result;
}

}  // namespace meniscus::loads
