#include "pipeline/case_data/feature_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace meniscus::case_data {

namespace {

Vector1 unit_of(const Vector1& v) { return v / sqrt(v.dot(v)); }

/// `v` made normal to the unit vector `n`, of unit length.
Vector1 unit_across(const Vector1& v, const Vector1& n) {
  return unit_of(v - n * v.dot(n));
}

/// Names curves and faces after the feature.
class ShapeList {
 public:
  explicit ShapeList(const FeatureEntry& feature) : feature_(feature) {}

  std::string name(const std::string& part) const {
    return feature_.name + "/" + part;
  }
  void add_circle(const std::string& part, const Vector1& center,
                  const Vector1& normal, const Dual1& radius) {
    result.curves.push_back(
        {name(part), CircleOfDuals{center, normal, radius}});
  }
  void add_polygon(const std::string& part,
                   const std::vector<Vector1>& corners) {
    result.curves.push_back(
        {name(part), PathOfDuals{corners, std::vector<std::optional<Vector1>>(
                                              corners.size())}});
  }
  /// A plane face; `holes`: whole names of curves.
  void add_plane(const std::string& face, const std::string& rim,
                 std::vector<std::string> holes = {}) {
    result.faces.push_back(
        {.name = name(face), .curve = name(rim), .more = std::move(holes)});
  }
  void add_ring(const std::string& face, const std::string& outer,
                const std::string& inner) {
    result.faces.push_back(
        {.name = name(face), .curve = name(outer), .inner = name(inner)});
  }
  void add_patch(const std::string& face, const std::string& curve) {
    result.faces.push_back(
        {.name = name(face), .curve = name(curve), .ruled = true});
  }

  FeatureShapes result;

 private:
  const FeatureEntry& feature_;
};

class BossShape {
 public:
  BossShape(const FeatureEntry& feature, const FeatureNumbers& numbers)
      : feature_(feature),
        n_(numbers),
        axis_(unit_of(numbers.axis)),
        list_(feature) {}

  FeatureShapes build() {
    const bool bored = feature_.bore.has_value();
    circle("seat", n_.height);
    std::vector<std::string> holes;
    if (bored) {
      add_bore();
      holes = {list_.name(feature_.chamfer ? "chamfer" : "bore")};
    }
    list_.add_plane("seat", "seat", holes);
    const std::string low = add_rim(0);
    if (feature_.rims.size() == 1) {
      add_side("side", "seat", low);
      return std::move(list_.result);
    }
    const std::string high = add_rim(1);
    add_side("side", "seat", high);
    if (low != "base") {
      circle("base", 0.0);
      add_side("base_side", low, "base");
    }
    const bool through = bored && !feature_.depth;
    list_.add_plane("base", "base",
                    through ? std::vector<std::string>{list_.name("bore_end")}
                            : std::vector<std::string>{});
    return std::move(list_.result);
  }

 private:
  Vector1 center(const Dual1& height) const {
    return n_.at - axis_ * (n_.height - height);
  }
  void circle(const std::string& part, const Dual1& height) {
    list_.add_circle(
        part, center(height), axis_,
        n_.base_radius + (n_.radius - n_.base_radius) * height / n_.height);
  }
  void add_side(const std::string& face, const std::string& upper,
                const std::string& lower) {
    if (upper != lower) {
      list_.add_ring(face, upper, lower);
    }
  }
  /// The curve where the film begins, by its part of the name.
  std::string add_rim(std::size_t k) {
    const FeatureRim& rim = feature_.rims[k];
    if (rim.place == FeatureRim::Place::Seat) {
      return "seat";
    }
    if (rim.place == FeatureRim::Place::Base) {
      circle("base", 0.0);
      return "base";
    }
    const std::string part =
        feature_.rims.size() == 1 ? "rim" : fmt::format("rim_{}", k + 1);
    circle(part, n_.rims[k]);
    return part;
  }
  void add_bore() {
    const Dual1 top = n_.height - n_.chamfer;
    const Dual1 end = feature_.depth ? n_.height - n_.depth : Dual1(0.0);
    list_.add_circle("bore", center(top), axis_, n_.bore);
    list_.add_circle("bore_end", center(end), axis_, n_.bore);
    if (feature_.chamfer) {
      list_.add_circle("chamfer", center(n_.height), axis_,
                       n_.bore + n_.chamfer);
      list_.add_ring("chamfer", "chamfer", "bore");
    }
    list_.add_ring("bore", "bore", "bore_end");
    if (feature_.depth) {
      list_.add_plane("floor", "bore_end");
    }
  }

  const FeatureEntry& feature_;
  const FeatureNumbers& n_;
  Vector1 axis_;
  ShapeList list_;
};

/// A flange's outline in its plane, counter-clockwise seen from its axis: four
/// sides and, between them, corners round or sharp.
PathOfDuals flange_outline(const FeatureEntry& feature, const FeatureNumbers& n,
                           const Vector1& center) {
  const Vector1 axis = unit_of(n.axis);
  const Vector1 right = unit_across(n.across, axis);
  const std::array<Vector1, 2> way = {right, axis.cross(right)};
  const std::array<Dual1, 2> half = {n.width / 2.0, n.length / 2.0};
  PathOfDuals path;
  const Dual1 r = feature.corner_radius ? n.corner_radius : Dual1(0.0);
  for (int k = 0; k < 4; ++k) {
    // Side k lies at `out` and ends where the corner to the next begins.
    const int i = k % 2;
    const Vector1 out = way[i] * (k < 2 ? 1.0 : -1.0);
    const Vector1 along = way[1 - i] * (k == 0 || k == 3 ? 1.0 : -1.0);
    const Vector1 middle =
        center + out * (half[i] - r) + along * (half[1 - i] - r);
    if (feature.corner_radius) {
      path.corners.push_back(center + out * half[i] -
                             along * (half[1 - i] - r));
      path.via.emplace_back();
      path.corners.push_back(middle + out * r);
      path.via.emplace_back(middle + (out + along) * (r * std::sqrt(0.5)));
    } else {
      path.corners.push_back(center + out * half[i] - along * half[1 - i]);
      path.via.emplace_back();
    }
  }
  return path;
}

/// The faces between a flange's two outlines, which have as many corners.
void add_flange_edge(const PathOfDuals& top, const PathOfDuals& bottom,
                     ShapeList& list) {
  int sides = 0;
  int corners = 0;
  for (std::size_t k = 0; k < top.corners.size(); ++k) {
    const std::size_t next = (k + 1) % top.corners.size();
    const bool round = top.via[k].has_value();
    const std::string part = round ? fmt::format("corner_{}", ++corners)
                                   : fmt::format("side_{}", ++sides);
    list.result.curves.push_back(
        {list.name(part),
         PathOfDuals{{top.corners[k], top.corners[next], bottom.corners[next],
                      bottom.corners[k]},
                     {top.via[k], std::nullopt, bottom.via[k], std::nullopt}}});
    if (round) {
      list.add_patch(part, part);
    } else {
      list.add_plane(part, part);
    }
  }
}

FeatureShapes flange_shapes(const FeatureEntry& feature,
                            const FeatureNumbers& n) {
  ShapeList list(feature);
  const Vector1 axis = unit_of(n.axis);
  const Vector1 down = -axis * n.thickness;
  const Vector1 below = n.at + down;
  if (feature.round) {
    list.add_circle("top", n.at, axis, n.radius);
    list.add_circle("bottom", below, axis, n.radius);
    list.add_ring("edge", "top", "bottom");
  } else {
    const PathOfDuals top = flange_outline(feature, n, n.at);
    const PathOfDuals bottom = flange_outline(feature, n, below);
    list.result.curves.push_back({list.name("top"), top});
    list.result.curves.push_back({list.name("bottom"), bottom});
    add_flange_edge(top, bottom, list);
  }
  std::vector<std::string> in_top;
  std::vector<std::string> in_bottom;
  for (std::size_t k = 0; k < feature.holes.size(); ++k) {
    const std::string part = fmt::format("hole_{}", k + 1);
    const Vector1 off =
        k < n.holes.size() ? Vector1(n.holes[k] - n.at) : n.across;
    const Vector1 center = n.at + off - axis * off.dot(axis);
    list.add_circle(part, center, axis, n.hole_radius);
    list.add_circle(part + "_end", center + down, axis, n.hole_radius);
    list.add_ring(part, part, part + "_end");
    in_top.push_back(list.name(part));
    in_bottom.push_back(list.name(part + "_end"));
  }
  in_top.insert(in_top.end(), feature.rim_curves.begin(),
                feature.rim_curves.end());
  list.add_plane("top", "top", in_top);
  list.add_plane("bottom", "bottom", in_bottom);
  return std::move(list.result);
}

/// Half a lug's outline in its plane: x across, y to the foot. The side is
/// tangent to the round end.
struct LugOutline {
  std::array<Dual1, 2> foot;
  std::array<Dual1, 2> shoulder;
};

LugOutline lug_outline(const FeatureNumbers& n) {
  const Dual1 x = n.width / 2.0;
  const Dual1 y = n.length;
  const Dual1& r = n.radius;
  const Dual1 d2 = x * x + y * y;
  const Dual1 side = sqrt(d2 - r * r);  // from the foot to the shoulder
  return {{x, y}, {r * (r * x + side * y) / d2, r * (r * y - side * x) / d2}};
}

FeatureShapes lug_shapes(const FeatureEntry& feature, const FeatureNumbers& n) {
  ShapeList list(feature);
  const Vector1 axis = unit_of(n.axis);
  const Vector1 to_foot = unit_across(n.across, axis);
  const Vector1 aside = axis.cross(to_foot);
  const LugOutline half = lug_outline(n);
  const auto point = [&](const Dual1& x, const Dual1& y, double face) {
    return Vector1(n.at + aside * x + to_foot * y +
                   axis * (n.thickness * (0.5 * face)));
  };
  struct LugFace {
    Vector1 foot_1, shoulder_1, end, shoulder_2, foot_2;
  };
  std::array<LugFace, 2> at;
  for (int k = 0; k < 2; ++k) {
    const double face = k == 0 ? 1.0 : -1.0;
    const std::string part = k == 0 ? "front" : "back";
    LugFace& o = at[k];
    o.foot_1 = point(half.foot[0], half.foot[1], face);
    o.shoulder_1 = point(half.shoulder[0], half.shoulder[1], face);
    o.end = point(0.0, -n.radius, face);
    o.shoulder_2 = point(-half.shoulder[0], half.shoulder[1], face);
    o.foot_2 = point(-half.foot[0], half.foot[1], face);
    list.result.curves.push_back(
        {list.name(part),
         PathOfDuals{{o.foot_1, o.shoulder_1, o.shoulder_2, o.foot_2},
                     {std::nullopt, o.end, std::nullopt, std::nullopt}}});
    list.add_circle("bore_" + part, point(0.0, 0.0, face), axis, n.bore);
    list.add_plane(part, part, {list.name("bore_" + part)});
  }
  const auto& [front, back] = at;
  list.add_polygon(
      "side_1", {front.foot_1, front.shoulder_1, back.shoulder_1, back.foot_1});
  list.add_polygon(
      "side_2", {front.foot_2, front.shoulder_2, back.shoulder_2, back.foot_2});
  list.result.curves.push_back(
      {list.name("end"),
       PathOfDuals{{front.shoulder_1, front.shoulder_2, back.shoulder_2,
                    back.shoulder_1},
                   {front.end, std::nullopt, back.end, std::nullopt}}});
  list.add_polygon("foot",
                   {front.foot_1, front.foot_2, back.foot_2, back.foot_1});
  list.add_plane("side_1", "side_1");
  list.add_plane("side_2", "side_2");
  list.add_patch("end", "end");
  list.add_ring("bore", "bore_front", "bore_back");
  return std::move(list.result);
}

FeatureShapes block_shapes(const FeatureEntry& feature,
                           const FeatureNumbers& n) {
  ShapeList list(feature);
  const Vector1 axis = unit_of(n.axis);
  const Vector1 right = unit_across(n.across, axis);
  const std::array<Vector1, 3> half = {
      Vector1(right * (n.size[0] / 2.0)),
      Vector1(axis.cross(right) * (n.size[1] / 2.0)),
      Vector1(axis * (n.size[2] / 2.0))};
  struct Face {
    const char* name;
    int along;
    double sign;
  };
  for (const Face& face :
       {Face{"right", 0, 1.0}, Face{"left", 0, -1.0}, Face{"back", 1, 1.0},
        Face{"front", 1, -1.0}, Face{"top", 2, 1.0}, Face{"bottom", 2, -1.0}}) {
    const Vector1 middle = n.at + half[face.along] * face.sign;
    const Vector1& u = half[(face.along + 1) % 3];
    const Vector1 v = half[(face.along + 2) % 3] * face.sign;
    list.add_polygon(face.name, {middle - u - v, middle + u - v, middle + u + v,
                                 middle - u + v});
    if (std::find(feature.open.begin(), feature.open.end(), face.name) ==
        feature.open.end()) {
      list.add_plane(face.name, face.name);
    }
  }
  return std::move(list.result);
}

}  // namespace

FeatureShapes feature_shapes(const FeatureEntry& feature,
                             const FeatureNumbers& numbers) {
  switch (feature.kind) {
    case FeatureKind::Boss:
      return BossShape(feature, numbers).build();
    case FeatureKind::Flange:
      return flange_shapes(feature, numbers);
    case FeatureKind::Lug:
      return lug_shapes(feature, numbers);
    case FeatureKind::Block:
      break;
  }
  return block_shapes(feature, numbers);
}

}  // namespace meniscus::case_data
