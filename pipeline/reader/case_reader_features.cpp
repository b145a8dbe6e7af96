/// Solids that films grow from: bosses, flanges, lugs and blocks.

#include <algorithm>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/feature_shapes.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

bool is_round_flange(const CaseTable& table) { return table.has("radius"); }

/// A direction of the file, or `otherwise`.
case_data::QuantityVector direction(const CaseTable& table, const char* key,
                                    const Vec3& otherwise) {
  if (const auto given = table.vector(key)) {
    return *given;
  }
  case_data::QuantityVector result;
  for (int k = 0; k < 3; ++k) {
    result[k] = {.expression = Expression(otherwise[k]),
                 .line = table.line(),
                 .key = table.path() + "." + key};
  }
  return result;
}

/// Of a boss: "base", "seat" or a height each, from the base to the seat.
std::vector<case_data::FeatureRim> read_boss_rims(CaseContext& context,
                                                  const CaseTable& table) {
  using Place = case_data::FeatureRim::Place;
  std::vector<case_data::FeatureRim> rims;
  const toml::node* node = table.node("rims");
  if (node == nullptr) {
    return {{.place = Place::Base, .height = {}}};
  }
  const toml::array* list = node->as_array();
  if (list == nullptr || list->empty() || list->size() > 2) {
    context.problems.add(
        table.line("rims"),
        fmt::format("{}.rims: found {}; expected one or two of \"base\", "
                    "\"seat\" and heights above the base, as [\"base\", 6]",
                    table.path(), described(*node)));
    return {{.place = Place::Base, .height = {}}};
  }
  for (const toml::node& item : *list) {
    const auto text = item.value<std::string>();
    case_data::FeatureRim& rim = rims.emplace_back();
    if (text == "base" || text == "seat") {
      rim.place = text == "base" ? Place::Base : Place::Seat;
      continue;
    }
    rim.place = Place::Height;
    rim.height =
        read_quantity(context, item, Dimension::Length, table.path() + ".rims")
            .value_or(case_data::Quantity{});
  }
  return rims;
}

void read_boss(CaseContext& context, const CaseTable& table,
               case_data::FeatureEntry& boss) {
  boss.radius = table.quantity_or_zero("radius");
  boss.height = table.quantity_or_zero("height");
  boss.base_radius = table.quantity("base_radius");
  boss.bore = table.quantity("bore");
  boss.depth = table.quantity("depth");
  boss.chamfer = table.quantity("chamfer");
  boss.rims = read_boss_rims(context, table);
  for (const char* key : {"depth", "chamfer"}) {
    if (table.has(key) && !boss.bore) {
      context.problems.add(
          table.line(key),
          fmt::format("{}.{} is of a bore; add bore, its radius", table.path(),
                      key));
    }
  }
  using Place = case_data::FeatureRim::Place;
  if (boss.rims.size() == 2 && (boss.rims[0].place == Place::Seat ||
                                boss.rims[1].place == Place::Base)) {
    context.problems.add(
        table.line("rims"),
        fmt::format("{}.rims go from the base to the seat: the second must be "
                    "higher, as in [\"base\", \"seat\"]",
                    table.path()));
  }
  if (boss.rims.size() == 1 && boss.rims.front().place != Place::Base) {
    context.problems.add(
        table.line("rims"),
        fmt::format("{}.rims names one rim, which must be \"base\": there the "
                    "liquid takes over; between two rims it goes around",
                    table.path()));
  }
  if (boss.rims.size() == 1 && boss.bore && !boss.depth) {
    context.problems.add(
        table.line("bore"),
        fmt::format("{}: a bore through ends in the liquid behind the base; "
                    "give it a depth, or the boss two rims",
                    table.path()));
  }
}

void read_flange(CaseContext& context, const CaseTable& table,
                 const std::vector<std::string>& curves,
                 case_data::FeatureEntry& flange) {
  flange.round = is_round_flange(table);
  flange.thickness = table.quantity_or_zero("thickness");
  const std::vector<const char*> sides = {"width", "length"};
  for (const char* key : sides) {
    if (table.has(key) == flange.round) {
      context.problems.add(
          table.line(key),
          fmt::format("{} {} {}; a flange has either a radius or width and "
                      "length",
                      table.path(),
                      flange.round ? "has both radius and" : "lacks", key));
    }
  }
  flange.radius = table.quantity_or_zero("radius");
  flange.width = table.quantity("width");
  flange.length = table.quantity_or_zero("length");
  flange.corner_radius = table.quantity("corner_radius");
  flange.holes = table.vectors("hole_centers");
  flange.hole_radius = table.quantity_or_zero("hole_radius");
  if (table.has("hole_centers") != table.has("hole_radius")) {
    context.problems.add(
        table.line(), fmt::format("{} has one of hole_centers and hole_radius; "
                                  "give both or neither",
                                  table.path()));
  }
  flange.rim_curves = table.names("curves");
  for (const std::string& curve : flange.rim_curves) {
    if (std::find(curves.begin(), curves.end(), curve) == curves.end()) {
      context.problems.unknown(table.line("curves"), "curve", curve, curves);
    }
  }
}

void read_lug(const CaseTable& table, case_data::FeatureEntry& lug) {
  lug.across = table.vector_or_zero("foot");
  lug.radius = table.quantity_or_zero("radius");
  lug.bore = table.quantity("bore");
  lug.thickness = table.quantity_or_zero("thickness");
  lug.length = table.quantity_or_zero("length");
  lug.width = table.quantity("width");
}

void read_block(CaseContext& context, const CaseTable& table,
                case_data::FeatureEntry& block) {
  block.size = table.vector_or_zero("size");
  block.open = table.names("open");
  const std::vector<std::string> faces = {"right", "left", "back",
                                          "front", "top",  "bottom"};
  for (const std::string& face : block.open) {
    if (std::find(faces.begin(), faces.end(), face) == faces.end()) {
      context.problems.unknown(table.line("open"), "face", face, faces);
    }
  }
}

std::vector<std::string> names_of_curves(const case_data::Case& result) {
  std::vector<std::string> names;
  for (const case_data::CurveEntry& curve : result.curves) {
    names.push_back(curve.name);
  }
  return names;
}

/// Null for no such one.
const case_data::FeatureEntry* feature_named(const case_data::Case& input,
                                             const std::string& name) {
  for (const case_data::FeatureEntry& feature : input.features) {
    if (feature.name == name) {
      return &feature;
    }
  }
  return nullptr;
}

/// Its edges, among the case's curves.
void add_curves(const case_data::FeatureEntry& feature, int index,
                case_data::Case& result) {
  int number = 0;
  for (const case_data::FeatureCurve& curve :
       case_data::feature_shapes(feature, {}).curves) {
    case_data::CurveEntry entry{.name = curve.name,
                                .kind = case_data::CurveKind::OfFeature,
                                .line = feature.line};
    entry.feature = index;
    entry.of_feature = number++;
    result.curves.push_back(std::move(entry));
  }
}

}  // namespace

const std::vector<FeatureRow>& feature_kinds() {
  using Kind = case_data::FeatureKind;
  static const std::vector<FeatureRow> kinds = {
      {"boss",
       Kind::Boss,
       {{"at", "axis", "radius", "height"},
        {"base_radius", "bore", "depth", "chamfer", "rims"}},
       "cylinder or cone with a bore: faces seat, bore, side and, with two "
       "rims, base"},
      {"flange",
       Kind::Flange,
       {{"at", "axis", "thickness"},
        {"across", "width", "length", "corner_radius", "radius", "hole_centers",
         "hole_radius", "curves"}},
       "plate with holes: faces top, bottom, hole_1, ..., and of a round one "
       "edge, "
       "of others side_1 to side_4 and corner_1 to corner_4"},
      {"lug",
       Kind::Lug,
       {{"at", "axis", "foot", "radius", "bore", "thickness", "length"},
        {"width"}},
       "plate with a pin bore and a round end: faces bore, front, back, "
       "side_1, "
       "side_2, end; its open foot is the curve NAME/foot"},
      {"block",
       Kind::Block,
       {{"at", "size"}, {"axis", "across", "open"}},
       "box: faces right, left, back, front, top, bottom, each within the "
       "curve "
       "of that name"}};
  return kinds;
}

bool is_feature(const CaseTable& table) {
  const toml::node* kind = table.node("kind");
  const auto text = kind == nullptr ? std::nullopt : kind->value<std::string>();
  return text &&
         std::any_of(feature_kinds().begin(), feature_kinds().end(),
                     [&](const FeatureRow& row) { return *text == row.name; });
}

void read_features(CaseContext& context, const std::vector<CaseTable>& solids,
                   case_data::Case& result) {
  const std::vector<std::string> curves = names_of_curves(result);
  for (const CaseTable& table : solids) {
    if (!is_feature(table)) {
      continue;
    }
    const auto kind = table.choice("kind");
    const FeatureRow& row = case_data::row_named(feature_kinds(), *kind);
    table.check_kind(*kind, row.keys);
    case_data::FeatureEntry feature{
        .name = table.name(), .kind = row.kind, .line = table.line()};
    feature.at = table.vector_or_zero("at");
    feature.axis = direction(table, "axis", Vec3::UnitZ());
    feature.across = direction(table, "across", Vec3::UnitX());
    switch (row.kind) {
      case case_data::FeatureKind::Boss:
        read_boss(context, table, feature);
        break;
      case case_data::FeatureKind::Flange:
        read_flange(context, table, curves, feature);
        break;
      case case_data::FeatureKind::Lug:
        read_lug(table, feature);
        break;
      case case_data::FeatureKind::Block:
        read_block(context, table, feature);
        break;
    }
    add_curves(feature, static_cast<int>(result.features.size()), result);
    result.features.push_back(std::move(feature));
  }
}

void add_feature_faces(const std::string& name, case_data::Case& result) {
  const case_data::FeatureEntry& feature = *feature_named(result, name);
  for (films::CapSpec& face : case_data::feature_shapes(feature, {}).faces) {
    result.caps.push_back({.spec = std::move(face), .line = feature.line});
  }
}

std::vector<std::string> with_feature_faces(
    const case_data::Case& input, const std::vector<std::string>& names) {
  std::vector<std::string> result;
  for (const std::string& name : names) {
    const auto solid =
        std::find_if(input.step_solids.begin(), input.step_solids.end(),
                     [&](const case_data::StepSolidEntry& s) {
                       return s.spec.name == name;
                     });
    if (solid != input.step_solids.end()) {
      for (const int face : solid->faces) {
        result.push_back(case_data::face_name(*solid, face));
      }
      continue;
    }
    const case_data::FeatureEntry* feature = feature_named(input, name);
    if (feature == nullptr) {
      result.push_back(name);
      continue;
    }
    for (const films::CapSpec& face :
         case_data::feature_shapes(*feature, {}).faces) {
      result.push_back(face.name);
    }
  }
  return result;
}

}  // namespace meniscus::reader
