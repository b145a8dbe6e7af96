#include "fea/functionals/displacement_functionals.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/element_sweep.h"
#include "fea/element/face_points.h"
#include "fea/element/surface_faces.h"
#include "fea/loads/load_checks.h"
#include "fea/loads/remote_gradient.h"
#include "fea/loads/remote_load.h"

namespace meniscus::functionals {

namespace {

/// A density over a surface: of place, and of s = u . d for a unit direction d.
struct Density {
  double value = 0.0;
  double by_s = 0.0;
  Vec3 by_position = Vec3::Zero();
};

Vec3 unit_direction(const std::string& surface, const Vec3& direction) {
  const double length = direction.norm();
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw InvalidInput(
        fmt::format("surface '{}': the direction ({}, {}, {}) has no length",
                    surface, direction.x(), direction.y(), direction.z()));
  }
  return direction / length;
}

void check_displacement(const TetMesh& mesh, const std::string& surface,
                        const VectorX& u) {
  if (u.size() != static_cast<Eigen::Index>(3 * mesh.nodes.size())) {
    throw InvalidInput(
        fmt::format("surface '{}': {} displacements for {} nodes", surface,
                    u.size(), mesh.nodes.size()));
  }
}

struct SurfaceMean {
  const TetMesh& mesh;
  const std::string& surface;
  Vec3 direction;  // unit
  element::FaceRule rule;
  const VectorX& displacement;
};

/// Mean of density(point, s) over the surface and, if `gradient`, all its
/// derivatives; by_direction is that by the unit direction.
template <class OfPlace>
element::DirectedFunctional surface_mean(const SurfaceMean& in,
                                         element::Derivatives derivatives,
                                         const OfPlace& density) {
  const int label = element::surface_label(in.mesh, in.surface);
  double area = 0.0;
  double sum = 0.0;
  const auto along = [&](int f, const element::FacePoint& point) {
    return element::value_at(in.mesh, f, point, in.displacement)
        .dot(in.direction);
  };
  // J = int rho(x, u . d) dA / A by the face rule.
  element::over_face_points(
      in.mesh, label, in.rule, [&](int f, const element::FacePoint& point) {
        const double share = point.normal.norm();
        area += share;
        sum += share * density(point, along(f, point)).value;
      });
  if (!(area > 0.0)) {
    throw InvalidInput(
        fmt::format("surface '{}' has an area of {}", in.surface, area));
  }
  element::DirectedFunctional result;
  result.value = sum / area;
  if (derivatives == element::Derivatives::None) {
    return result;
  }
  // Pulled back: dJ/du_a = int N_a rho_s d dA / A, and by d the mean of
  // rho_s u.
  result.by_nodes.assign(in.mesh.nodes.size(), Vec3::Zero());
  result.by_displacement = element::nodal_zeros(in.mesh);
  element::pull_back_faces(
      in.mesh, label, in.rule,
      [&](int f,
          const element::FacePoint& point) -> element::FacePointGradient {
        const Vec3 u = element::value_at(in.mesh, f, point, in.displacement);
        const Density at = density(point, u.dot(in.direction));
        const double share = point.normal.norm() / area;
        const auto ids = in.mesh.face(f);
        for (std::size_t a = 0; a < ids.size(); ++a) {
          result.by_displacement.segment<3>(3L * ids[a]) +=
              point.shape[a] * share * at.by_s * in.direction;
        }
        result.by_direction += share * at.by_s * u;
        // By place the slope of rho; by the area vector (rho - J) n / A,
        // because A changes as well.
        return {share * at.by_position,
                (at.value - result.value) / area * point.normal.normalized()};
      },
      result.by_nodes);
  return result;
}

/// From the derivative by the unit direction to that by the one given.
void turn_to_given(const Vec3& given, element::DirectedFunctional& result) {
  const Vec3 d = given.normalized();
  result.by_direction =
      (result.by_direction - d.dot(result.by_direction) * d) / given.norm();
}

void scale(double factor, element::DirectedFunctional& result) {
  for (Vec3& g : result.by_nodes) {
    g *= factor;
  }
  result.by_displacement *= factor;
  result.by_direction *= factor;
}

}  // namespace

element::DirectedFunctional mean_displacement_functional(
    const TetMesh& mesh, const std::string& surface, const Vec3& direction,
    const VectorX& displacement, element::Derivatives derivatives) {
  check_displacement(mesh, surface, displacement);
  element::DirectedFunctional result = surface_mean(
      {mesh, surface, unit_direction(surface, direction),
       element::FaceRule::Three, displacement},
      derivatives, [](const element::FacePoint&, double s) -> Density {
        return {s, 1.0, Vec3::Zero()};
      });
  turn_to_given(direction, result);
  return result;
}

element::DirectedFunctional weighted_displacement_functional(
    const TetMesh& mesh, const std::string& surface, const Vec3& direction,
    const loads::SlopedField& weight, const VectorX& displacement,
    element::Derivatives derivatives) {
  check_displacement(mesh, surface, displacement);
  const std::string what = fmt::format("the weight on surface '{}'", surface);
  const loads::LoadCase place{.name = "response"};
  const bool sloped = derivatives == element::Derivatives::All;
  if (sloped) {
    loads::require_slope(weight.slope, place, what);
  }
  element::DirectedFunctional result = surface_mean(
      {mesh, surface, unit_direction(surface, direction),
       element::FaceRule::Seven, displacement},
      derivatives, [&](const element::FacePoint& point, double s) -> Density {
        const double w =
            loads::field_value(weight.value, point.position, place, what);
        return {w * s, w,
                sloped
                    ? Vec3(s * loads::field_value(weight.slope, point.position,
                                                  place, what))
                    : Vec3(Vec3::Zero())};
      });
  turn_to_given(direction, result);
  return result;
}

element::DirectedFunctional displacement_norm_functional(
    const TetMesh& mesh, const std::string& surface, const Vec3& direction,
    double power, const VectorX& displacement,
    element::Derivatives derivatives) {
  check_displacement(mesh, surface, displacement);
  if (!(power >= 2.0) || !std::isfinite(power)) {
    throw InvalidInput(fmt::format(
        "surface '{}': the power of a norm of displacements is {}; it must be "
        "2 or above",
        surface, power));
  }
  const Vec3 d = unit_direction(surface, direction);
  double largest = 0.0;
  for (const int i :
       element::surface_nodes(mesh, element::surface_label(mesh, surface))) {
    largest =
        std::max(largest, std::abs(displacement.segment<3>(3L * i).dot(d)));
  }
  const double unit = largest > 0.0 ? largest : 1.0;
  element::DirectedFunctional result = surface_mean(
      {mesh, surface, d, element::FaceRule::Seven, displacement}, derivatives,
      [&](const element::FacePoint&, double s) -> Density {
        const double t = s / unit;
        const double tail = std::pow(std::abs(t), power - 2.0);
        return {tail * t * t, power * tail * t / unit, Vec3::Zero()};
      });
  const double mean = result.value;
  result.value = unit * std::pow(mean, 1.0 / power);
  scale(mean > 0.0 ? result.value / (power * mean) : 0.0, result);
  turn_to_given(direction, result);
  return result;
}

element::DirectedFunctional rotation_functional(
    const TetMesh& mesh, const std::string& surface, const Vec3& axis,
    const VectorX& displacement, element::Derivatives derivatives) {
  check_displacement(mesh, surface, displacement);
  const loads::RemoteLoad load{.surfaces = surface,
                               .moment = unit_direction(surface, axis)};
  element::DirectedFunctional result;
  if (derivatives == element::Derivatives::None) {
    result.value =
        loads::remote_gradient(mesh, load, displacement, nullptr).value;
    return result;
  }
  result.by_nodes.assign(mesh.nodes.size(), Vec3::Zero());
  const loads::RemoteGradient gradient =
      loads::remote_gradient(mesh, load, displacement, &result.by_nodes);
  result.value = gradient.value;
  result.by_displacement = element::nodal_zeros(mesh);
  const loads::SurfaceWeights w = loads::surface_weights(mesh, surface);
  const Points forces = loads::remote_forces(mesh, w, load);
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    result.by_displacement.segment<3>(3L * w.nodes[k]) = forces[k];
  }
  result.by_direction = gradient.by_moment;
  turn_to_given(axis, result);
  return result;
}

}  // namespace meniscus::functionals
