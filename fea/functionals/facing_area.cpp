#include "fea/functionals/facing_area.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "fea/element/face_points.h"

namespace meniscus::functionals {

namespace {

/// A number and its derivative.
struct Switch {
  double value = 0.0;
  double slope = 0.0;
};

/// From 0 at t = -1 to 1 at t = 1 with two derivatives.
Switch smooth_switch(double t) {
  if (t <= -1.0 || t >= 1.0) {
    return {t < 0.0 ? 0.0 : 1.0, 0.0};
  }
  const double s = t * t;
  return {0.5 + t * (15.0 - s * (10.0 - 3.0 * s)) / 16.0,
          15.0 / 16.0 * (1.0 - s) * (1.0 - s)};
}

/// Which facets count, and by what: the cosine of their normal to `axis`, or
/// its size with the sign changed.
struct Facing {
  Vec3 axis = Vec3::Zero();  // unit
  bool either_side = false;
  double limit = 0.0;
  double half_width = 0.0;
  std::vector<char> labels;  // 1: counts

  /// Its slope is that by n . axis.
  Switch of(double cosine) const {
    const double sign = either_side && cosine > 0.0 ? -1.0 : 1.0;
    Switch result = smooth_switch((sign * cosine - limit) / half_width);
    result.slope *= sign / half_width;
    return result;
  }
};

int label_of(const TetMesh& mesh, const std::string& surface) {
  const auto& names = mesh.labels;
  const auto at = std::find(names.begin(), names.end(), surface);
  if (at == names.end()) {
    throw InvalidInput(
        fmt::format("facing area: there is no surface '{}'; there are {}",
                    surface, fmt::join(names, ", ")));
  }
  return static_cast<int>(at - names.begin());
}

Vec3 unit_of(const Vec3& direction) {
  if (!(direction.norm() > 0.0) || !direction.allFinite()) {
    throw InvalidInput(
        "facing area: the direction has length 0; expected any other");
  }
  return direction.normalized();
}

void check_limits(const FacingLimits& limits) {
  constexpr double kRight = 1.5707963267948966;  // [rad]
  if (!(limits.angle > 0.0) || !(limits.angle < kRight) ||
      !(limits.width > 0.0) || !(limits.width < limits.angle)) {
    throw InvalidInput(fmt::format(
        "facing area: the angle is {:g} rad and the width {:g}; expected an "
        "angle above 0 and below a right one, and a width below it",
        limits.angle, limits.width));
  }
}

/// visit(face) of the outer faces that count.
template <class Visit>
void over_faces(const TetMesh& mesh, const Facing& facing, const Visit& visit) {
  for (int f = 0; f < mesh.face_count(); ++f) {
    if ((mesh.face_front.empty() || mesh.face_front[f] < 0) &&
        facing.labels[mesh.face_label[f]] != 0) {
      visit(f);
    }
  }
}

/// `length` with its sign: of the direction as given over the axis.
element::DirectedFunctional facing_area(const TetMesh& mesh,
                                        const Facing& facing, double length,
                                        element::Derivatives derivatives) {
  const element::FaceQuadrature rule(mesh.order, element::FaceRule::Seven);
  element::DirectedFunctional result;
  const bool all = derivatives == element::Derivatives::All;
  if (all) {
    result.by_nodes.assign(mesh.nodes.size(), Vec3::Zero());
  }
  over_faces(mesh, facing, [&](int f) {
    for (int q = 0; q < rule.size(); ++q) {
      const Vec3 normal = rule.at(mesh, f, q).normal;
      const double area = normal.norm();
      const Vec3 n = normal / area;
      const double cosine = n.dot(facing.axis);
      const Switch counts = facing.of(cosine);
      result.value += counts.value * area;
      if (all && (counts.value != 0.0 || counts.slope != 0.0)) {
        rule.pull_back(
            mesh, f, q, Vec3::Zero(),
            counts.value * n + counts.slope * (facing.axis - cosine * n),
            result.by_nodes);
        result.by_direction +=
            counts.slope * area / length * (n - cosine * facing.axis);
      }
    }
  });
  return result;
}

}  // namespace

element::DirectedFunctional overhang_functional(
    const TetMesh& mesh, const Vec3& direction, const FacingLimits& limits,
    const std::vector<std::string>& base, element::Derivatives derivatives) {
  check_limits(limits);
  Facing facing{.axis = -unit_of(direction),
                .limit = std::cos(limits.angle),
                .half_width = std::sin(limits.angle) * std::sin(limits.width),
                .labels = std::vector<char>(mesh.labels.size(), 1)};
  for (const std::string& surface : base) {
    facing.labels[label_of(mesh, surface)] = 0;
  }
  return facing_area(mesh, facing, -direction.norm(), derivatives);
}

element::DirectedFunctional draft_functional(const TetMesh& mesh,
                                             const Vec3& direction,
                                             const FacingLimits& limits,
                                             const std::string& on,
                                             element::Derivatives derivatives) {
  check_limits(limits);
  Facing facing{
      .axis = -unit_of(direction),
      .either_side = on.empty(),
      .limit = -std::sin(limits.angle),
      .half_width = std::cos(limits.angle) * std::sin(limits.width),
      .labels = std::vector<char>(mesh.labels.size(), on.empty() ? 1 : 0)};
  if (!on.empty()) {
    facing.labels[label_of(mesh, on)] = 1;
  }
  return facing_area(mesh, facing, -direction.norm(), derivatives);
}

}  // namespace meniscus::functionals
