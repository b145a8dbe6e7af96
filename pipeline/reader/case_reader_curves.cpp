#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

struct CurveRow {
  const char* name;
  case_data::CurveKind kind;
  case_data::KindKeys keys;
  std::string_view doc;
};

const std::vector<CurveRow>& curve_kinds() {
  using Kind = case_data::CurveKind;
  static const std::vector<CurveRow> kinds = {
      {"circle",
       Kind::Circle,
       {{"center", "normal", "radius"}, {"pieces", "free"}},
       case_data::kWithNext},
      {"ellipse",
       Kind::Ellipse,
       {{"center", "normal", "axis", "radius_1", "radius_2"},
        {"pieces", "free"}},
       case_data::kWithNext},
      {"rectangle",
       Kind::Rectangle,
       {{"center", "normal", "axis", "width", "height"},
        {"corner_radius", "pieces", "free"}},
       ""},
      {"polygon",
       Kind::Polygon,
       {{"points"}, {"pieces", "free"}},
       "straight sides"},
      {"spline",
       Kind::Spline,
       {{"points"}, {"pieces", "free"}},
       "smooth through points"},
      {"polyline",
       Kind::Polyline,
       {{"points"}, {"pieces", "free"}},
       "straight sides and circular arcs"},
      {"file",
       Kind::Spline,  // or what the file holds
       {{"file"}, {"as", "edge", "face", "pieces", "free"}},
       "points from a file"},
      {"copy",
       Kind::Copy,
       {{"of"},
        {"offset", "scale", "scales", "mirror", "rotate", "axis", "about",
         "move", "pieces", "free"}},
       "another curve offset, scaled, mirrored, turned, moved"}};
  return kinds;
}

case_data::Quantity fixed(const CaseTable& table, const char* key,
                          double value) {
  return {.expression = Expression(value),
          .line = table.line(key),
          .key = fmt::format("{}.{}", table.path(), key)};
}

/// What arcs go through stands between two corners.
void check_path(CaseContext& context, const CaseTable& table,
                const case_data::CurveEntry& curve) {
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    if (!curve.points[k].through) {
      continue;
    }
    const case_data::SourceLine line = curve.points[k].at[0].line;
    if (curve.kind != case_data::CurveKind::Polyline) {
      context.problems.add(
          line, fmt::format("{}.points[{}] has 'through', which only a "
                            "polyline knows; expected [x, y, z]",
                            table.path(), k));
    } else if (k == 0 || curve.points[k - 1].through) {
      context.problems.add(
          line,
          fmt::format("{}.points[{}]: an arc goes from the corner before it to "
                      "the one after it; put {} before it",
                      table.path(), k, k == 0 ? "a corner" : "another corner"));
    }
  }
}

/// The curve above that a copy is of; -1 with a problem noted.
int find_curve(CaseContext& context, const CaseTable& table,
               const toml::table& root, const case_data::Case& result) {
  const auto wanted = table.text("of");
  if (!wanted) {
    return -1;
  }
  std::vector<std::string> known;
  for (const case_data::CurveEntry& curve : result.curves) {
    if (curve.name == *wanted) {
      return static_cast<int>(known.size());
    }
    known.push_back(curve.name);
  }
  if (*wanted == table.name()) {
    context.problems.add(table.line("of"),
                         fmt::format("{} is a copy of itself", table.path()));
  } else if (root["curves"][*wanted].is_table()) {
    context.problems.add(table.line("of"),
                         fmt::format("{}.of: [curves.{}] stands below; move it "
                                     "above its copy",
                                     table.path(), *wanted));
  } else {
    context.problems.unknown(table.line("of"), "curve", *wanted, known);
  }
  return -1;
}

void read_copy(CaseContext& context, const CaseTable& table,
               const toml::table& root, const case_data::Case& result,
               case_data::CurveEntry& curve) {
  case_data::CopyEntry& copy = curve.copy;
  copy.of = find_curve(context, table, root, result);
  copy.offset = table.quantity("offset");
  if (copy.offset && copy.of >= 0 &&
      result.curves[static_cast<std::size_t>(copy.of)].kind ==
          case_data::CurveKind::Copy) {
    context.problems.add(
        table.line("offset"),
        fmt::format("{}.offset: '{}' is a copy itself, and copies have no "
                    "offset; give its offset to '{}', or copy the first curve",
                    table.path(),
                    result.curves[static_cast<std::size_t>(copy.of)].name,
                    result.curves[static_cast<std::size_t>(copy.of)].name));
  }
  const case_data::Quantity uniform =
      table.quantity("scale").value_or(fixed(table, "scale", 1.0));
  copy.scale = table.vector("scales").value_or(
      case_data::QuantityVector{uniform, uniform, uniform});
  if (table.has("scale") && table.has("scales")) {
    context.problems.add(table.line("scales"),
                         table.path() + " has both scale and scales; keep one");
  }
  copy.mirror = table.vector("mirror");
  read_motion(context, table, curve);
}

/// true, or some sides of a polygon or polyline, counted from 1.
void read_free(CaseContext& context, const CaseTable& table,
               case_data::CurveEntry& curve) {
  const toml::node* node = table.node("free");
  const toml::array* list = node == nullptr ? nullptr : node->as_array();
  if (list == nullptr) {
    curve.free = table.flag("free").value_or(false);
    return;
  }
  const bool has_sides = curve.fixed_points.empty() &&
                         (curve.kind == case_data::CurveKind::Polygon ||
                          curve.kind == case_data::CurveKind::Polyline);
  const auto sides =
      has_sides ? std::count_if(curve.points.begin(), curve.points.end(),
                                [](const case_data::PathPoint& point) {
                                  return !point.through;
                                })
                : 0;
  for (const toml::node& item : *list) {
    const auto side = item.value_exact<std::int64_t>();
    if (!side || *side < 1 || *side > sides) {
      context.problems.add(
          context.line_of(item),
          has_sides
              ? fmt::format("{}.free has {}; its sides are 1 to {}, side 1 "
                            "from the first point to the next",
                            table.path(), described(item), sides)
              : fmt::format("{}.free lists sides, which polygons and "
                            "polylines have; expected true or false",
                            table.path()));
      return;
    }
    curve.free_sides.push_back(static_cast<int>(*side) - 1);
  }
}

case_data::CurveEntry read_curve(CaseContext& context, const CaseTable& table,
                                 const toml::table& root,
                                 case_data::Case& result) {
  case_data::CurveEntry curve{.name = table.name(), .line = table.line()};
  const auto kind = table.choice("kind");
  if (!kind) {
    return curve;
  }
  if (table.has("pieces")) {
    curve.pieces = constant_above(context, table, "pieces", 0.0, 1.0);
  }
  const CurveRow& row = case_data::row_named(curve_kinds(), *kind);
  table.check_kind(*kind, row.keys);
  curve.kind = row.kind;
  if (*kind == "copy") {
    read_copy(context, table, root, result, curve);
    return curve;
  }
  if (*kind == "file") {
    read_curve_file(context, table, result, curve);
    return curve;
  }
  curve.center = table.vector_or_zero("center");
  curve.normal = table.vector_or_zero("normal");
  curve.axis = table.vector_or_zero("axis");
  curve.radius = table.quantity_or_zero("radius");
  curve.radius_1 = table.quantity_or_zero("radius_1");
  curve.radius_2 = table.quantity_or_zero("radius_2");
  curve.width = table.quantity_or_zero("width");
  curve.height = table.quantity_or_zero("height");
  curve.corner_radius = table.quantity_or_zero("corner_radius");
  curve.points = table.path_points("points");
  check_path(context, table, curve);
  return curve;
}

}  // namespace

void read_motion(CaseContext& context, const CaseTable& table,
                 case_data::CurveEntry& curve) {
  case_data::CopyEntry& copy = curve.copy;
  copy.angle = table.quantity("rotate").value_or(fixed(table, "rotate", 0.0));
  curve.axis = table.vector("axis").value_or(case_data::QuantityVector{
      fixed(table, "axis", 0.0), fixed(table, "axis", 0.0),
      fixed(table, "axis", 1.0)});
  if (table.has("rotate") != table.has("axis")) {
    context.problems.add(
        table.line(table.has("axis") ? "axis" : "rotate"),
        fmt::format("{} has {}; add it, it is turned right-handed about axis "
                    "by the angle rotate",
                    table.path(),
                    table.has("axis") ? "an axis and no rotate"
                                      : "rotate and no axis"));
  }
  copy.about = table.vector_or_zero("about");
  copy.move = table.vector_or_zero("move");
}

TableSpec curve_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "curves",
      true,
      TableNeed::Optional,
      "A closed boundary curve, counter-clockwise seen from its normal's tip",
      {{"kind", K::Choice, D::None, true,
        "its shape: " + case_data::meanings_of(curve_kinds()),
        case_data::choices_of(curve_kinds()), "arc"},
       {"center", K::Vector, D::Length, false, "of circle, ellipse, rectangle"},
       {"normal", K::Vector, std::nullopt, false,
        "of circle, ellipse, rectangle; any length but 0"},
       {"axis", K::Vector, std::nullopt, false,
        "of ellipse, rectangle: direction of radius_1 or width; of copy: what "
        "it is turned about"},
       {"radius", K::Quantity, D::Length, false, "of circle"},
       {"radius_1", K::Quantity, D::Length, false, "of ellipse, along axis"},
       {"radius_2", K::Quantity, D::Length, false, "of ellipse, across axis"},
       {"width", K::Quantity, D::Length, false, "of rectangle: along axis"},
       {"height", K::Quantity, D::Length, false, "of rectangle: across it"},
       {"corner_radius", K::Quantity, D::Length, false,
        "of rectangle; 0 when left out"},
       {"points", K::Path, D::Length, false,
        "of polygon, spline, polyline, in order; they close by themselves. In "
        "a polyline { through = [x, y, z] } makes the side between its "
        "neighbours an arc"},
       {"file", K::Text, D::None, false,
        "of file: a csv file with a head row x,y,z, units if it likes (x "
        "[in]), or a STEP file; relative to the case file"},
       {"as", K::Choice, D::None, false,
        "of a csv file: what the points make; spline when left out",
        case_data::choices_of(point_curves())},
       {"edge", K::NamesOrNumbers, D::None, false,
        "of a STEP file: a closed edge, or several that close, by name or "
        "number: 7, \"rim\", [3, 4]; or"},
       {"face", K::NamesOrNumbers, D::None, false,
        "of a STEP file: the face whose outer rim it is, by name or number"},
       {"pieces", K::Constant, D::Length, false,
        "edges along it, where stress is to be resolved: films and elements "
        "grow from there by 0.4 of the distance; at most resolution.fea, which "
        "it is when left out"},
       {"free", K::Sides, D::None, false,
        "three films or more begin along it, and their line moves to where "
        "they balance; of polygon and polyline also some sides alone, side 1 "
        "from the first point to the next: [2, 3]. false when left out"},
       {"of", K::Name, D::None, false, "of copy: a curve that stands above"},
       {"offset", K::Quantity, D::Length, false,
        "of copy: outwards in the curve's plane, below 0 inwards; corners "
        "stay sharp, arcs concentric. Not of a copy"},
       {"scale", K::Quantity, D::None, false, "of copy: a factor above 0, or"},
       {"scales", K::Vector, D::None, false,
        "of copy: factors along x, y, z, above 0"},
       {"mirror", K::Vector, std::nullopt, false,
        "of copy: normal of the mirror plane; any length but 0"},
       {"rotate", K::Quantity, D::None, false,
        "of copy: angle in radians, right-handed about axis"},
       {"about", K::Vector, D::Length, false,
        "of copy: the point that scaling, mirror plane and axis go through; "
        "the origin when left out"},
       {"move", K::Vector, D::Length, false, "of copy: added at the end"}}};
}

void read_curves(CaseContext& context, const toml::table& root,
                 case_data::Case& result) {
  for (const CaseTable& table : named_tables(context, root, "curves")) {
    result.curves.push_back(read_curve(context, table, root, result));
    read_free(context, table, result.curves.back());
  }
}

}  // namespace meniscus::reader
