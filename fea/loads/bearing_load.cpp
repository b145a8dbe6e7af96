#include "fea/loads/bearing_load.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "fea/element/surface_faces.h"
#include "fea/loads/loads.h"

namespace meniscus::loads {

namespace {

using Vec4 = Eigen::Vector4d;

/// Of the normals' second moments: below this part of the next an axis.
constexpr double kAxis = 0.25;
/// Below this part of the largest the next says that the surface is flat.
constexpr double kFlat = 1e-3;
/// A pin turns in its bore by less, in force x radius.
constexpr double kTurn = 0.02;

template <class Visit>
void over_bore_points(const TetMesh& mesh, const Surfaces& surfaces,
                      const Visit& visit) {
  for (const std::string& surface : surfaces) {
    element::over_face_points(mesh, element::surface_label(mesh, surface),
                              element::FaceRule::Seven, visit);
  }
}

[[noreturn]] void refuse(const BearingLoad& load, const std::string& what) {
  throw InvalidInput(fmt::format("the bearing load on surface '{}' {}",
                                 load.surfaces.text(), what));
}

/// Second moments of the normals.
Mat3 normal_moments(const TetMesh& mesh, const Surfaces& surfaces) {
  Mat3 moments = Mat3::Zero();
  over_bore_points(mesh, surfaces, [&](int, const element::FacePoint& point) {
    moments += point.normal * point.normal.transpose() / point.normal.norm();
  });
  return moments;
}

std::string shown(const Vec3& v) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x(), v.y(), v.z());
}

}  // namespace

BearingPressure::BearingPressure(const TetMesh& mesh, const BearingLoad& load) {
  if (!load.force.allFinite() || load.force.isZero(0.0) ||
      !value_of(load.point).allFinite() || !value_of(load.axis).allFinite()) {
    refuse(load,
           "has a force of 0, or a force, point or axis that is not "
           "finite");
  }
  surface_weights(mesh, load.surfaces);  // refuses surfaces without area
  find_axis(mesh, load);
  const Vec3 any = Vec3::Unit([&] {
    Eigen::Index least = 0;
    axis_.cwiseAbs().minCoeff(&least);
    return least;
  }());
  basis_.col(0) = across(any).normalized();
  basis_.col(1) = axis_.cross(basis_.col(0));
  balanced_ = load.point.has_value();
  point_ = value_of(load.point);
  if (!across(load.force).isZero(0.0)) {
    balance(mesh, load);
    check_turn(mesh, load);
  }
}

void BearingPressure::find_axis(const TetMesh& mesh, const BearingLoad& load) {
  if (load.axis) {
    if (load.axis->isZero(0.0)) {
      refuse(load, "has an axis without length");
    }
    axis_ = load.axis->normalized();
    return;
  }
  const auto eigen = symmetric_eigen(normal_moments(mesh, load.surfaces));
  if (!(eigen.values[1] > kFlat * eigen.values[2]) ||
      !(eigen.values[0] < kAxis * eigen.values[1])) {
    refuse(load, "is on no bore that shows its axis; give it (axis)");
  }
  fitted_ = true;
  spread_ = eigen.values;
  directions_ = eigen.vectors;
  axis_ = eigen.vectors.col(0);
}

Vec4 BearingPressure::shape(const element::FacePoint& point) const {
  const Eigen::Vector2d m = -basis_.transpose() * point.normal;
  Vec4 b;
  b << m, height(point.position) * m;
  return b;
}

double BearingPressure::pressed(const element::FacePoint& point) const {
  return std::max(0.0, shape(point).dot(y_));
}

Vec3 BearingPressure::force_at(const element::FacePoint& point) const {
  return -pressed(point) / point.normal.norm() * across(point.normal);
}

/// Newton's method on the convex 1/2 int max(0, b . y)^2 dA - g . y, which is
/// quadratic but where points begin or end to be pressed: it ends exactly.
void BearingPressure::balance(const TetMesh& mesh, const BearingLoad& load) {
  constexpr int kMostSteps = 60;
  constexpr double kRounding = 1e-14;
  Vec4 g = Vec4::Zero();
  g.head<2>() = basis_.transpose() * load.force;
  const auto at = [&](const Vec4& y, Vec4& gradient, Eigen::Matrix4d& H) {
    double value = -g.dot(y);
    gradient = -g;
    H.setZero();
    over_bore_points(mesh, load.surfaces,
                     [&](int, const element::FacePoint& point) {
                       const Vec4 b = shape(point);
                       const double p = b.dot(y);
                       if (p > 0.0 || y.isZero(0.0)) {
                         const double share = 1.0 / point.normal.norm();
                         value += 0.5 * share * p * p;
                         gradient += share * p * b;
                         H += share * b * b.transpose();
                       }
                     });
    return value;
  };
  // The scale of heights: that of rows of the last two equations.
  double size = 0.0;
  over_bore_points(mesh, load.surfaces,
                   [&](int, const element::FacePoint& point) {
                     size = std::max(size, std::abs(height(point.position)));
                   });
  Vec4 gradient;
  double value = at(y_, gradient, H_);
  const auto error = [&](const Vec4& r) {
    return r.head<2>().norm() + (size > 0.0 ? r.tail<2>().norm() / size : 0.0);
  };
  for (int step = 0; step < kMostSteps; ++step) {
    const Vec4 d = -solve_ldlt4(H_, gradient);
    double length = y_.isZero(0.0) ? 2.0 : 1.0;  // half of a bore is pressed
    Vec4 next_gradient;
    Eigen::Matrix4d next_H;
    double next = at(y_ + length * d, next_gradient, next_H);
    while (!(next <= value + 1e-4 * length * gradient.dot(d)) &&
           length > 1e-6 && error(next_gradient) > kRounding * g.norm()) {
      length *= 0.5;
      next = at(y_ + length * d, next_gradient, next_H);
    }
    y_ += length * d;
    value = next;
    gradient = next_gradient;
    H_ = next_H;
    if (error(gradient) <= kRounding * g.norm()) {
      return;
    }
  }
  constexpr double kEnough = 1e-11;
  if (!(error(gradient) <= kEnough * g.norm())) {
    refuse(load,
           fmt::format("cannot carry {} across its axis {} by pressure alone: "
                       "no part of it faces that way{}",
                       shown(load.force), shown(axis_),
                       balanced_ ? ", or the point lies far outside it" : ""));
  }
}

void BearingPressure::check_turn(const TetMesh& mesh,
                                 const BearingLoad& load) const {
  if (!balanced_) {
    return;
  }
  double moment = 0.0;
  double area = 0.0;
  double second = 0.0;
  Vec3 first = Vec3::Zero();
  over_bore_points(mesh, load.surfaces,
                   [&](int, const element::FacePoint& point) {
                     const Vec3 arm = across(point.position - point_);
                     moment += axis_.dot(arm.cross(force_at(point)));
                     const double share = point.normal.norm();
                     area += share;
                     first += share * arm;
                     second += share * arm.squaredNorm();
                   });
  const double radius =
      std::sqrt(std::max(0.0, second / area - (first / area).squaredNorm()));
  const double force = across(load.force).norm();
  if (std::abs(moment) > kTurn * force * radius) {
    refuse(load,
           fmt::format("turns about its axis {} through {}: the point lies "
                       "{:.3g} beside the line that the pressure acts along; "
                       "put it on the axis",
                       shown(axis_), shown(point_), std::abs(moment) / force));
  }
}

std::array<Vec3, 2> BearingPressure::adjoint(const Vec4& work) const {
  const Vec4 mu = solve_ldlt4(H_, work);
  return {basis_ * mu.head<2>(), basis_ * mu.tail<2>()};
}

Mat3 BearingPressure::by_normals(const Vec3& g) const {
  // An eigenvector's change: sum v_k (v_k . dA a) / (l_a - l_k).
  Vec3 c = Vec3::Zero();
  for (int k = 1; k < 3; ++k) {
    const Vec3 v = directions_.col(k);
    c += v.dot(g) / (spread_[0] - spread_[k]) * v;
  }
  return 0.5 * (c * axis_.transpose() + axis_ * c.transpose());
}

void add_bearing_forces(const TetMesh& mesh, const BearingLoad& load,
                        VectorX& f) {
  const BearingPressure pressure(mesh, load);
  over_bore_points(mesh, load.surfaces,
                   [&](int face, const element::FacePoint& point) {
                     const Vec3 force = pressure.force_at(point);
                     const auto ids = mesh.face(face);
                     for (std::size_t a = 0; a < ids.size(); ++a) {
                       f.segment<3>(3L * ids[a]) += point.shape[a] * force;
                     }
                   });
  const SurfaceWeights w = surface_weights(mesh, load.surfaces);
  const Vec3 even =
      pressure.axis().dot(load.force) * pressure.axis() / w.weights.sum();
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    f.segment<3>(3L * w.nodes[k]) +=
        w.weights[static_cast<Eigen::Index>(k)] * even;
  }
}

}  // namespace meniscus::loads
