/// Curves that come from files: csv points, and edges of STEP files.
#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cad/step/step_edges.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "pipeline/files/curve_file.h"
#include "pipeline/files/step_curve.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

std::filesystem::path place_of(const case_data::Case& result,
                               const std::string& path) {
  return std::filesystem::path(result.path).parent_path() / path;
}

/// Notes keys that belong to files of the other kind.
void refuse_keys(CaseContext& context, const CaseTable& table,
                 const std::vector<const char*>& keys, const char* of) {
  for (const char* key : keys) {
    if (table.has(key)) {
      context.problems.add(
          table.line(key),
          fmt::format("{}.{} is of {}; take it out", table.path(), key, of));
    }
  }
}

void read_points(CaseContext& context, const CaseTable& table,
                 const std::string& path, case_data::Case& result,
                 case_data::CurveEntry& curve) {
  refuse_keys(context, table, {"edge", "face"}, "STEP files");
  curve.kind = case_data::row_named(point_curves(),
                                    table.choice("as").value_or("spline"))
                   .value;
  if (const std::string* text =
          file_text(context, table, path,
                    "a csv file with columns x, y, z or a STEP file", result)) {
    files::CurveFile file = files::read_curve_text(
        *text, place_of(result, path).string(), context.units);
    for (const std::string& problem : file.problems) {
      context.problems.add_text(problem);
    }
    if (!file.warning.empty()) {
      context.problems.warn(table.line("file"), file.warning);
    }
    curve.fixed_points = std::move(file.points);
  }
}

/// What an entry of numbers from a file is made of: constants at the line of
/// the key `file`.
class FixedCurve {
 public:
  FixedCurve(const CaseTable& table, case_data::CurveEntry& curve)
      : line_(table.line("file")), key_(table.path()), curve_(curve) {}

  void operator()(const curves::Circle& circle) {
    curve_.kind = case_data::CurveKind::Circle;
    curve_.center = vector(circle.center);
    curve_.normal = vector(circle.normal);
    curve_.radius = number(circle.radius);
  }
  void operator()(const curves::Ellipse& ellipse) {
    curve_.kind = case_data::CurveKind::Ellipse;
    curve_.center = vector(ellipse.center);
    curve_.normal = vector(ellipse.normal);
    curve_.axis = vector(ellipse.axis);
    curve_.radius_1 = number(ellipse.radius_1);
    curve_.radius_2 = number(ellipse.radius_2);
  }
  void operator()(const curves::Spline& spline) {
    curve_.kind = case_data::CurveKind::Spline;
    curve_.fixed_points = spline.points;
  }
  void operator()(const curves::Polyline& line) {
    curve_.kind = case_data::CurveKind::Polyline;
    for (std::size_t k = 0; k < line.corners.size(); ++k) {
      curve_.points.push_back({vector(line.corners[k]), false});
      if (line.via[k]) {
        curve_.points.push_back({vector(*line.via[k]), true});
      }
    }
  }
  template <class Shape>
  void operator()(const Shape& /*shape*/) {}  // STEP gives no others

 private:
  case_data::Quantity number(double value) const {
    return {.expression = Expression(value), .line = line_, .key = key_};
  }
  case_data::QuantityVector vector(const Vec3& v) const {
    return {number(v[0]), number(v[1]), number(v[2])};
  }

  case_data::SourceLine line_;
  std::string key_;
  case_data::CurveEntry& curve_;
};

/// What a curve of a STEP file is: edges, or the rim of a face.
struct StepNames {
  std::vector<std::string> edges;
  std::vector<std::string> faces;
  const char* key = "edge";  // that names them
};

/// The curve's text, from the case or, fitted, from the file.
std::string step_text(CaseContext& context, const CaseTable& table,
                      const std::string& path, const StepNames& names,
                      case_data::Case& result) {
  const auto& [edges, faces, named] = names;
  if (edges.empty() && faces.empty()) {
    return "";  // noted
  }
  const std::string key =
      fmt::format("{}#{}={}", path, edges.empty() ? "face" : "edge",
                  fmt::join(edges.empty() ? faces : edges, ","));
  if (const case_data::CaseFile* file = held_file(result, key)) {
    return file->text;
  }
  const std::string place = place_of(result, path).string();
  if (!std::filesystem::is_regular_file(place)) {
    context.problems.add(
        table.line("file"),
        fmt::format("{}.file: there is no file '{}'; expected a STEP file, its "
                    "path relative to the case",
                    table.path(), place));
    return "";
  }
  const char* at = "file";
  try {
    const std::string unit = context.units.unit_of(Dimension::Length);
    auto& file = context.step_files[place];
    if (!file) {
      file = std::make_shared<step::StepEdges>(place, unit);
    }
    at = named;
    const step::StepLoop loop =
        edges.empty() ? file->rim(faces.front()) : file->loop(edges);
    files::StepCurve curve = files::fit_step_loop(loop, unit);
    result.files.push_back({key, files::step_curve_text(curve)});
    return result.files.back().text;
  } catch (const Error& error) {
    context.problems.add(table.line(at), fmt::format("{}.{}: {}", table.path(),
                                                     at, error.what()));
  }
  return "";
}

bool read_step_curve(CaseContext& context, const CaseTable& table,
                     const std::string& path, const StepNames& names,
                     case_data::Case& result, case_data::CurveEntry& curve) {
  const std::string text = step_text(context, table, path, names, result);
  if (text.empty()) {
    return false;
  }
  try {
    const files::StepCurve found = files::read_step_curve_text(text);
    std::visit(FixedCurve(table, curve), found.shape);
    result.remarks.push_back(
        fmt::format("{}: {}: {}", case_data::place(result, table.line("file")),
                    table.path(), found.description));
    return true;
  } catch (const InvalidInput& error) {
    context.problems.add(table.line("file"), error.what());
  }
  return false;
}

void read_step_edges(CaseContext& context, const CaseTable& table,
                     const std::string& path, case_data::Case& result,
                     case_data::CurveEntry& curve) {
  refuse_keys(context, table, {"as"}, "csv files");
  const bool edge = table.has("edge");
  if (edge == table.has("face")) {
    context.problems.add(
        table.line("file"),
        fmt::format("{} has {}; expected one of them: edge = 7 (or a name, or "
                    "several that close) or face = \"pad\"",
                    table.path(),
                    edge ? "both edge and face" : "neither edge nor face"));
    return;
  }
  if (table.names_or_numbers("face").size() > 1) {
    context.problems.add(table.line("face"),
                         table.path() + ".face: expected one face");
    return;
  }
  read_step_curve(context, table, path,
                  {table.names_or_numbers("edge"),
                   table.names_or_numbers("face"), edge ? "edge" : "face"},
                  result, curve);
}

}  // namespace

bool read_step_loop(CaseContext& context, const CaseTable& table,
                    const std::string& path,
                    const std::vector<std::string>& edges, const char* at,
                    case_data::Case& result, case_data::CurveEntry& curve) {
  return read_step_curve(context, table, path, {edges, {}, at}, result, curve);
}

const case_data::CaseFile* held_file(const case_data::Case& result,
                                     const std::string& path) {
  const auto at = std::find_if(
      result.files.begin(), result.files.end(),
      [&](const case_data::CaseFile& file) { return file.path == path; });
  return at == result.files.end() ? nullptr : &*at;
}

const std::string* file_text(CaseContext& context, const CaseTable& table,
                             const std::string& path, const char* expected,
                             case_data::Case& result) {
  if (const case_data::CaseFile* file = held_file(result, path)) {
    return &file->text;
  }
  const std::filesystem::path place = place_of(result, path);
  if (!std::filesystem::is_regular_file(place)) {
    context.problems.add(
        table.line("file"),
        fmt::format("{}.file: there is no file '{}'; expected {}, its path "
                    "relative to the case",
                    table.path(), place.string(), expected));
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

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return ending;
}

const std::vector<case_data::Named<case_data::CurveKind>>& point_curves() {
  static const std::vector<case_data::Named<case_data::CurveKind>> kinds = {
      {"spline", case_data::CurveKind::Spline},
      {"polygon", case_data::CurveKind::Polygon}};
  return kinds;
}

void read_curve_file(CaseContext& context, const CaseTable& table,
                     case_data::Case& result, case_data::CurveEntry& curve) {
  const auto path = table.text("file");
  if (!path) {
    return;
  }
  const std::string ending = ending_of(*path);
  if (ending == ".csv") {
    read_points(context, table, *path, result, curve);
  } else if (ending == ".step" || ending == ".stp") {
    read_step_edges(context, table, *path, result, curve);
  } else {
    context.problems.add(
        table.line("file"),
        fmt::format("{}.file is '{}'; expected a file that ends in .csv, .step "
                    "or .stp",
                    table.path(), *path));
  }
}

}  // namespace meniscus::reader
