#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "io/atomic_file.h"
#include "pipeline/case_reader_tables.h"
#include "pipeline/curve_file.h"

namespace meniscus {

namespace {

const std::map<std::string, KindKeys>& curve_kinds() {
  static const std::map<std::string, KindKeys> kinds = {
      {"circle", {{"center", "normal", "radius"}, {"repeat"}}},
      {"ellipse",
       {{"center", "normal", "axis", "radius_1", "radius_2"}, {"repeat"}}},
      {"rectangle",
       {{"center", "normal", "axis", "width", "height"},
        {"corner_radius", "repeat"}}},
      {"polygon", {{"points"}, {"repeat"}}},
      {"spline", {{"points"}, {"repeat"}}},
      {"polyline", {{"points"}, {"repeat"}}},
      {"file", {{"file"}, {"as"}}},
      {"copy",
       {{"of"},
        {"offset", "scale", "scales", "mirror", "rotate", "axis", "about",
         "move", "repeat"}}}};
  return kinds;
}

CurveKind kind_of(const std::string& kind, const CaseTable& table) {
  static const std::map<std::string, CurveKind> kinds = {
      {"circle", CurveKind::Circle},
      {"ellipse", CurveKind::Ellipse},
      {"rectangle", CurveKind::Rectangle},
      {"polygon", CurveKind::Polygon},
      {"spline", CurveKind::Spline},
      {"polyline", CurveKind::Polyline},
      {"copy", CurveKind::Copy}};
  if (kind == "file") {
    return table.choice("as").value_or("spline") == "polygon"
               ? CurveKind::Polygon
               : CurveKind::Spline;
  }
  return kinds.at(kind);
}

Quantity fixed(const CaseTable& table, const char* key, double value) {
  return {.expression = Expression(value),
          .line = table.line(key),
          .key = fmt::format("{}.{}", table.path(), key)};
}

/// What arcs go through stands between two corners.
void check_path(CaseContext& context, const CaseTable& table,
                const CurveEntry& curve) {
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    if (!curve.points[k].through) {
      continue;
    }
    const SourceLine line = curve.points[k].at[0].line;
    if (curve.kind != CurveKind::Polyline) {
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

/// The text of a file that the case names, from disk unless the case holds it.
const std::string* text_of(CaseContext& context, const CaseTable& table,
                           const std::string& path, Case& result) {
  for (const CaseFile& file : result.files) {
    if (file.path == path) {
      return &file.text;
    }
  }
  const std::filesystem::path place =
      std::filesystem::path(result.path).parent_path() / path;
  if (!std::filesystem::is_regular_file(place)) {
    context.problems.add(
        table.line("file"),
        fmt::format("{}.file: there is no file '{}'; expected a csv file with "
                    "columns x, y, z, its path relative to the case",
                    table.path(), place.string()));
    return nullptr;
  }
  try {
    result.files.push_back({path, read_file(place)});
  } catch (const IoError& error) {
    context.problems.add(table.line("file"), error.what());
    return nullptr;
  }
  return &result.files.back().text;
}

void read_file_points(CaseContext& context, const CaseTable& table,
                      Case& result, CurveEntry& curve) {
  const auto path = table.text("file");
  if (!path) {
    return;
  }
  std::string ending = std::filesystem::path(*path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  if (ending != ".csv") {
    context.problems.add(
        table.line("file"),
        fmt::format("{}.file is '{}'; expected a file that ends in .csv",
                    table.path(), *path));
    return;
  }
  if (const std::string* text = text_of(context, table, *path, result)) {
    const std::string place =
        (std::filesystem::path(result.path).parent_path() / *path).string();
    CurveFile file = read_curve_text(*text, place, context.units);
    for (const std::string& problem : file.problems) {
      context.problems.add_text(problem);
    }
    curve.fixed_points = std::move(file.points);
  }
}

/// The curve above that a copy is of; -1 with a problem noted.
int find_curve(CaseContext& context, const CaseTable& table,
               const toml::table& root, const Case& result) {
  const auto wanted = table.text("of");
  if (!wanted) {
    return -1;
  }
  std::vector<std::string> known;
  for (const CurveEntry& curve : result.curves) {
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
               const toml::table& root, const Case& result, CurveEntry& curve) {
  CopyEntry& copy = curve.copy;
  copy.of = find_curve(context, table, root, result);
  copy.offset = table.quantity("offset");
  if (copy.offset && copy.of >= 0 &&
      result.curves[static_cast<std::size_t>(copy.of)].kind ==
          CurveKind::Copy) {
    context.problems.add(
        table.line("offset"),
        fmt::format("{}.offset: '{}' is a copy itself, and copies have no "
                    "offset; give its offset to '{}', or copy the first curve",
                    table.path(),
                    result.curves[static_cast<std::size_t>(copy.of)].name,
                    result.curves[static_cast<std::size_t>(copy.of)].name));
  }
  const Quantity uniform =
      table.quantity("scale").value_or(fixed(table, "scale", 1.0));
  copy.scale = table.vector("scales").value_or(
      QuantityVector{uniform, uniform, uniform});
  if (table.has("scale") && table.has("scales")) {
    context.problems.add(table.line("scales"),
                         table.path() + " has both scale and scales; keep one");
  }
  copy.mirror = table.vector("mirror");
  copy.angle = table.quantity("rotate").value_or(fixed(table, "rotate", 0.0));
  curve.axis = table.vector("axis").value_or(
      QuantityVector{fixed(table, "axis", 0.0), fixed(table, "axis", 0.0),
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

constexpr std::size_t kMostRepeats = 4000;

/// i, or i and j, or i, j and k of each repetition, the last running fastest;
/// one without any where nothing is repeated.
std::vector<std::vector<int>> places_of(CaseContext& context,
                                        const CaseTable& table) {
  std::vector<std::vector<int>> places = {{}};
  const std::vector<int> counts = table.counts("repeat");
  static const std::vector<std::string> letters = {"i", "j", "k"};
  for (std::size_t axis = 0; axis < counts.size(); ++axis) {
    if (std::find(context.names.begin(), context.names.end(), letters[axis]) !=
        context.names.end()) {
      context.problems.add(
          table.line("repeat"),
          fmt::format("{} counts with {}, which is also a parameter or design "
                      "variable; give that another name",
                      table.path(), letters[axis]));
    }
    std::vector<std::vector<int>> more;
    for (const std::vector<int>& place : places) {
      for (int index = 1; index <= counts[axis]; ++index) {
        more.push_back(place);
        more.back().push_back(index);
      }
    }
    places = std::move(more);
    if (places.size() > kMostRepeats) {
      context.problems.add(
          table.line("repeat"),
          fmt::format("{} makes {} curves or more; at most {} are taken",
                      table.path(), places.size(), kMostRepeats));
      return {std::vector<int>(counts.size(), 1)};
    }
  }
  return places;
}

/// What a pattern makes must not be there already.
void check_new_name(CaseContext& context, const CaseTable& table,
                    const toml::table& root, const Case& result,
                    const CurveEntry& curve) {
  if (curve.name == table.name()) {
    return;
  }
  const bool above =
      std::any_of(result.curves.begin(), result.curves.end(),
                  [&](const CurveEntry& c) { return c.name == curve.name; });
  if (above || root["curves"][curve.name].is_table()) {
    context.problems.add(
        table.line("repeat"),
        fmt::format("{} makes '{}', which is there already; rename one",
                    table.path(), curve.name));
  }
}

CurveEntry read_curve(CaseContext& context, const CaseTable& table,
                      const toml::table& root, Case& result) {
  CurveEntry curve{.name = table.name(), .line = table.line()};
  const auto kind = table.choice("kind");
  if (!kind) {
    return curve;
  }
  table.check_kind(*kind, curve_kinds().at(*kind));
  curve.kind = kind_of(*kind, table);
  if (*kind == "copy") {
    read_copy(context, table, root, result, curve);
    return curve;
  }
  if (*kind == "file") {
    read_file_points(context, table, result, curve);
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

void read_curves(CaseContext& context, const toml::table& root, Case& result) {
  for (const CaseTable& table : named_tables(context, root, "curves")) {
    for (const std::vector<int>& place : places_of(context, table)) {
      context.indices.assign(place.begin(), place.end());
      CurveEntry curve = read_curve(context, table, root, result);
      for (const int index : place) {
        curve.name += fmt::format("_{}", index);
      }
      check_new_name(context, table, root, result, curve);
      result.curves.push_back(std::move(curve));
    }
    context.indices.clear();
  }
}

}  // namespace meniscus
