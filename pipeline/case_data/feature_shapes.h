/// Bosses, flanges, lugs and blocks: the curves of their edges and the faces
/// between them. Numbers are duals, so that the curves' derivatives come with
/// them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/math/dual.h"
#include "evolve/films/film_system.h"
#include "pipeline/case_data/case_entries.h"

namespace meniscus::case_data {

using Vector1 = Eigen::Matrix<Dual1, 3, 1>;

/// The numbers of a FeatureEntry; lengths in case units. Where the kind's own
/// are left out, those of a sound feature stand in for them.
struct FeatureNumbers {
  Vector1 at = Vec3(Vec3::Zero()).cast<Dual1>();
  Vector1 axis = Vec3(Vec3::UnitZ()).cast<Dual1>();
  Vector1 across = Vec3(Vec3::UnitX()).cast<Dual1>();
  Dual1 radius = 2.0, bore = 1.0, height = 2.0, thickness = 1.0;
  Dual1 width = 8.0, length = 8.0;
  Dual1 base_radius = 2.0, depth = 1.0, chamfer = 0.0;
  Dual1 corner_radius = 0.0, hole_radius = 0.1;
  Vector1 size = Vec3(Vec3::Ones()).cast<Dual1>();
  std::vector<Vector1> holes;
  std::array<Dual1, 2> rims = {0.5, 1.5};  // heights above a boss's base
};

struct CircleOfDuals {
  Vector1 center, normal;
  Dual1 radius;
};
/// A polygon where nothing is an arc, else a polyline.
struct PathOfDuals {
  std::vector<Vector1> corners;
  std::vector<std::optional<Vector1>> via;  // one per corner
};

struct FeatureCurve {
  std::string name;  // NAME/...
  std::variant<CircleOfDuals, PathOfDuals> shape;
};

struct FeatureShapes {
  std::vector<FeatureCurve> curves;
  std::vector<films::CapSpec> faces;
};

/// Always the same names in the same order for one entry.
///
/// boss: a cylinder or cone about its axis, from the base at height 0 to the
/// seat, whose middle `at` is. One rim at the base, where the liquid begins, or
/// two, between which it does.
/// flange: a plate below its top face, whose middle `at` is.
/// lug: a plate about the middle `at` of its bore, whose axis is the plate's;
/// its foot, an open rectangle, lies at `length` along `across`, its other end
/// is round.
/// block: about its middle `at`.
FeatureShapes feature_shapes(const FeatureEntry& feature,
                             const FeatureNumbers& numbers);

}  // namespace meniscus::case_data
