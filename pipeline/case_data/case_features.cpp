#include "pipeline/case_data/case_features.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace meniscus::case_data {

namespace {

constexpr int kRimSamples = 64;
constexpr double kInPlane = 1e-9;  // x the feature's size

double component(const Dual1& x, bool rate) {
  return rate ? x.gradient[0] : x.value;
}

Vec3 component(const Vector1& v, bool rate) {
  return {component(v[0], rate), component(v[1], rate), component(v[2], rate)};
}

curves::CurveShape shape_from(const CircleOfDuals& circle, bool rate) {
  return curves::Circle{component(circle.center, rate),
                        component(circle.normal, rate),
                        component(circle.radius, rate)};
}

curves::CurveShape shape_from(const PathOfDuals& path, bool rate) {
  curves::Polyline line;
  bool straight = true;
  for (std::size_t k = 0; k < path.corners.size(); ++k) {
    line.corners.push_back(component(path.corners[k], rate));
    line.via.emplace_back();
    if (path.via[k]) {
      line.via.back() = component(*path.via[k], rate);
      straight = false;
    }
  }
  if (straight) {
    return curves::Polygon{line.corners};
  }
  return line;
}

Vector1 vector_of(const QuantityVector& quantities, const CaseValues& values) {
  return {values.dual(quantities[0]), values.dual(quantities[1]),
          values.dual(quantities[2])};
}

/// Notes what is wrong with one feature's sizes.
class FeatureCheck {
 public:
  FeatureCheck(const Case& input, const FeatureEntry& feature,
               const CaseValues& values)
      : input_(input),
        feature_(feature),
        values_(values),
        n_(numbers_of(feature, values)) {}

  void run() {
    check_directions();
    switch (feature_.kind) {
      case FeatureKind::Boss:
        check_boss();
        break;
      case FeatureKind::Flange:
        check_flange();
        break;
      case FeatureKind::Lug:
        check_lug();
        break;
      case FeatureKind::Block:
        for (int k = 0; k < 3; ++k) {
          require(n_.size[k].value > 0.0, "size", n_.size[k].value,
                  "all three above 0");
        }
        break;
    }
  }

 private:
  void add(const std::string& text) {
    values_.problems().push_back(fmt::format("{}: solids.{}: {}{}",
                                             place(input_, feature_.line),
                                             feature_.name, text, where()));
  }
  void require(bool good, const char* key, double found,
               const std::string& must_be) {
    if (!good) {
      add(fmt::format("{} is {:.6g}; it must be {}", key, found, must_be));
    }
  }
  std::string where() const {
    const FeatureEntry& f = feature_;
    const auto or_none = [](const std::optional<Quantity>& quantity) {
      return quantity.value_or(Quantity{});
    };
    return values_.where(
        f.at, f.axis, f.across, f.radius, f.height, f.thickness, f.length,
        or_none(f.bore), or_none(f.base_radius), or_none(f.depth),
        or_none(f.chamfer), or_none(f.width), or_none(f.corner_radius), f.size,
        f.holes, f.hole_radius);
  }

  void check_directions() {
    const Vec3 axis = component(n_.axis, false);
    const Vec3 across = component(n_.across, false);
    const double length = axis.norm();
    if (!(length > 0.0)) {
      add("axis has length 0; give it a direction");
      return;
    }
    if (feature_.kind == FeatureKind::Boss ||
        (feature_.kind == FeatureKind::Flange && feature_.round)) {
      return;
    }
    constexpr double kParallel = 1e-6;
    const char* key = feature_.kind == FeatureKind::Lug ? "foot" : "across";
    if (!(axis.cross(across).norm() > kParallel * length * across.norm())) {
      add(fmt::format("{} must have a length and another direction than axis",
                      key));
    }
  }

  void check_boss() {
    const double height = n_.height.value;
    require(height > 0.0, "height", height, "above 0");
    require(n_.radius.value > 0.0, "radius", n_.radius.value, "above 0");
    require(n_.base_radius.value > 0.0, "base_radius", n_.base_radius.value,
            "above 0");
    if (feature_.bore) {
      check_bore(height);
    }
    double below = -1.0;
    for (std::size_t k = 0; k < feature_.rims.size(); ++k) {
      const FeatureRim& rim = feature_.rims[k];
      const double at = rim.place == FeatureRim::Place::Seat ? height
                        : rim.place == FeatureRim::Place::Base
                            ? 0.0
                            : n_.rims[k].value;
      if (rim.place == FeatureRim::Place::Height) {
        require(at > 0.0 && at < height, "rims", at,
                "between 0, the base, and height, the seat");
      }
      if (!(at > below)) {
        add("rims go from the base to the seat: the second must be higher");
      }
      below = at;
    }
  }

  void check_bore(double height) {
    const double bore = n_.bore.value;
    const double chamfer = n_.chamfer.value;
    const double depth = feature_.depth ? n_.depth.value : height;
    require(bore > 0.0, "bore", bore, "above 0");
    const double seat = n_.radius.value;
    const double end = n_.base_radius.value + (seat - n_.base_radius.value) *
                                                  (height - depth) / height;
    require(
        bore < std::min(seat, end), "bore", bore,
        fmt::format("below {:.6g}, or no wall is left", std::min(seat, end)));
    if (feature_.chamfer) {
      require(chamfer > 0.0 && chamfer < depth, "chamfer", chamfer,
              "above 0 and below the bore's depth");
      require(bore + chamfer < seat, "chamfer", chamfer,
              "below radius - bore, or it cuts off the seat");
    }
    if (feature_.depth) {
      require(depth > 0.0 && depth < height, "depth", depth,
              "above 0 and below height; leave it out for a bore through");
    }
  }

  void check_lug() {
    const double radius = n_.radius.value;
    const double bore = n_.bore.value;
    const double half = 0.5 * n_.width.value;
    const double length = n_.length.value;
    require(n_.thickness.value > 0.0, "thickness", n_.thickness.value,
            "above 0");
    require(bore > 0.0, "bore", bore, "above 0");
    require(
        radius > bore, "radius", radius,
        fmt::format("above bore = {:.6g}, or no wall is left around it", bore));
    require(half > 0.0, "width", n_.width.value, "above 0");
    require(length > bore, "length", length,
            "above bore, or the foot cuts the bore");
    require(half * half + length * length > radius * radius, "length", length,
            "so long that the foot lies outside the round end");
  }

  void check_flange() {
    require(n_.thickness.value > 0.0, "thickness", n_.thickness.value,
            "above 0");
    if (feature_.round) {
      require(n_.radius.value > 0.0, "radius", n_.radius.value, "above 0");
    } else {
      require(n_.width.value > 0.0, "width", n_.width.value, "above 0");
      require(n_.length.value > 0.0, "length", n_.length.value, "above 0");
      const double corner = n_.corner_radius.value;
      require(!feature_.corner_radius ||
                  (corner > 0.0 &&
                   2.0 * corner < std::min(n_.width.value, n_.length.value)),
              "corner_radius", corner,
              "above 0 and below half the shorter side; leave it out for "
              "sharp corners");
    }
    check_holes();
  }

  /// How far a place of the flange's plane lies within its outline.
  double inside(double x, double y) const {
    if (feature_.round) {
      return n_.radius.value - std::hypot(x, y);
    }
    const double r = n_.corner_radius.value;
    const double u = std::abs(x) - 0.5 * n_.width.value + r;
    const double v = std::abs(y) - 0.5 * n_.length.value + r;
    const double out = std::hypot(std::max(u, 0.0), std::max(v, 0.0)) +
                       std::min(std::max(u, v), 0.0);
    return r - out;
  }

  void check_holes() {
    const Vec3 axis = component(n_.axis, false).normalized();
    Vec3 x = component(n_.across, false);
    x = (x - x.dot(axis) * axis).normalized();
    const Vec3 at = component(n_.at, false);
    const double radius = n_.hole_radius.value;
    if (n_.holes.empty()) {
      return;
    }
    require(radius > 0.0, "hole_radius", radius, "above 0");
    std::vector<Eigen::Vector2d> centers;
    for (const Vector1& hole : n_.holes) {
      const Vec3 off = component(hole, false) - at;
      centers.emplace_back(off.dot(x), off.dot(axis.cross(x)));
    }
    check_apart(centers, radius);
    for (std::size_t i = 0; i < centers.size(); ++i) {
      if (!(inside(centers[i].x(), centers[i].y()) > radius)) {
        add(fmt::format("hole {} of radius {:.6g} reaches across the edge",
                        i + 1, radius));
        return;
      }
    }
  }

  /// Tells the first two holes that meet.
  void check_apart(const std::vector<Eigen::Vector2d>& centers, double radius) {
    for (std::size_t i = 0; i < centers.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double apart = (centers[i] - centers[j]).norm();
        if (!(apart > 2.0 * radius)) {
          add(
              fmt::format("holes {} and {} meet: {:.6g} between their middles, "
                          "radius {:.6g}",
                          j + 1, i + 1, apart, radius));
          return;
        }
      }
    }
  }

  const Case& input_;
  const FeatureEntry& feature_;
  const CaseValues& values_;
  FeatureNumbers n_;
};

}  // namespace

FeatureNumbers numbers_of(const FeatureEntry& feature,
                          const CaseValues& values) {
  FeatureNumbers n;
  const auto number = [&](const std::optional<Quantity>& quantity,
                          const Dual1& otherwise) {
    return quantity ? values.dual(*quantity) : otherwise;
  };
  n.at = vector_of(feature.at, values);
  n.axis = vector_of(feature.axis, values);
  n.across = vector_of(feature.across, values);
  n.radius = values.dual(feature.radius);
  n.height = values.dual(feature.height);
  n.thickness = values.dual(feature.thickness);
  n.length = values.dual(feature.length);
  n.bore = number(feature.bore, 0.0);
  n.base_radius = number(feature.base_radius, n.radius);
  n.depth = number(feature.depth, 0.0);
  n.chamfer = number(feature.chamfer, 0.0);
  n.width = number(feature.width, 2.0 * n.radius);
  n.corner_radius = number(feature.corner_radius, 0.0);
  n.size = vector_of(feature.size, values);
  n.hole_radius = values.dual(feature.hole_radius);
  for (const QuantityVector& hole : feature.holes) {
    n.holes.push_back(vector_of(hole, values));
  }
  for (std::size_t k = 0; k < feature.rims.size(); ++k) {
    n.rims[k] = values.dual(feature.rims[k].height);
  }
  return n;
}

std::vector<std::vector<curves::CurveShape>> feature_curves(
    const Case& input, const CaseValues& values) {
  std::vector<std::vector<curves::CurveShape>> result;
  result.reserve(input.features.size());
  for (const FeatureEntry& feature : input.features) {
    std::vector<curves::CurveShape>& shapes = result.emplace_back();
    for (const FeatureCurve& curve :
         feature_shapes(feature, numbers_of(feature, values)).curves) {
      shapes.push_back(std::visit(
          [&](const auto& shape) {
            return shape_from(shape, values.are_rates());
          },
          curve.shape));
    }
  }
  return result;
}

void check_features(const Case& input, const CaseValues& values) {
  for (const FeatureEntry& feature : input.features) {
    FeatureCheck(input, feature, values).run();
  }
}

void check_feature_rims(const Case& input,
                        const std::vector<curves::Curve>& curves,
                        const CaseValues& values) {
  for (const FeatureEntry& feature : input.features) {
    if (feature.rim_curves.empty()) {
      continue;
    }
    const FeatureNumbers n = numbers_of(feature, values);
    const Vec3 axis = component(n.axis, false).normalized();
    const Vec3 at = component(n.at, false);
    for (const curves::Curve& curve : curves) {
      if (std::find(feature.rim_curves.begin(), feature.rim_curves.end(),
                    curve.name) == feature.rim_curves.end()) {
        continue;
      }
      double off = 0.0;
      double size = 0.0;
      for (int k = 0; k < kRimSamples; ++k) {
        const Vec3 p =
            curves::point_at(curve.shape, static_cast<double>(k) / kRimSamples);
        off = std::max(off, std::abs((p - at).dot(axis)));
        size = std::max(size, (p - at).norm());
      }
      if (off > kInPlane * size) {
        values.problems().push_back(fmt::format(
            "{}: solids.{}: curve '{}' is off its top face by up to {:.4g}; "
            "films grow from curves in that face",
            place(input, feature.line), feature.name, curve.name, off));
      }
    }
  }
}

}  // namespace meniscus::case_data
