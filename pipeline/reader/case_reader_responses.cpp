#include "pipeline/reader/case_reader_responses.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/atomic_file.h"
#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/case_data/response_kinds.h"
#include "pipeline/case_data/scan_path.h"
#include "pipeline/files/content_hash.h"

namespace meniscus::reader {

bool takes_load_case(const case_data::ResponseEntry& entry) {
  const std::vector<std::string>& keys =
      case_data::row_of(entry.kind).keys.optional;
  return std::find(keys.begin(), keys.end(), "load_case") != keys.end();
}

namespace {

/// What a bound of eigenvalues is over, in parts of the least: two equal ones
/// are told 2 % too low, any number of them 9 %.
constexpr double kUsualCluster = 0.1;

/// The index of the name that `key` gives among `known`; 0, and a note, for a
/// name that is not there.
int index_among(CaseContext& context, const CaseTable& table, const char* key,
                const std::vector<std::string>& known) {
  const auto name = table.text(key);
  const auto at = std::find(known.begin(), known.end(), name.value_or(""));
  if (name && at == known.end()) {
    context.problems.unknown(table.line(key), key, *name, known);
  }
  return at == known.end() ? 0 : static_cast<int>(at - known.begin());
}

/// A radius is a mean of even powers; a norm of displacements has second
/// derivatives from 2 on.
double read_power(CaseContext& context, const CaseTable& table,
                  const case_data::ResponseEntry& response) {
  constexpr double kUsualOfRadius = 16.0;
  constexpr double kMostOfRadius = 64.0;
  const bool of_radius = response.kind == case_data::ResponseKind::Radius;
  const double usual = of_radius ? kUsualOfRadius : response.power;
  const double power = table.constant("power").value_or(usual);
  bool good = power > 1.0;
  std::string must_be = "above 1";
  if (of_radius) {
    good =
        power >= 2.0 && power <= kMostOfRadius && std::fmod(power, 2.0) == 0.0;
    must_be = fmt::format("even, from 2 to {:g}", kMostOfRadius);
  } else if (response.kind == case_data::ResponseKind::DisplacementNorm) {
    good = power >= 2.0;
    must_be = "2 or above";
  }
  if (!good) {
    context.problems.add(
        table.line("power"),
        fmt::format("{}.power is {:g}; it must be {}; {:g} when left out",
                    table.path(), power, must_be, usual));
    return usual;
  }
  return power;
}

bool any_yields(const case_data::Case& result) {
  const std::vector<case_data::BodyEntry> bodies =
      case_data::solid_bodies(result);
  return std::any_of(
      bodies.begin(), bodies.end(), [&](const case_data::BodyEntry& body) {
        const auto material = static_cast<std::size_t>(body.material);
        return material < result.materials.size() &&
               result.materials[material].yield_strength;
      });
}

/// What stress norms are measured in; the least yield strength when left out.
std::optional<double> stress_scale(CaseContext& context, const CaseTable& table,
                                   const case_data::ResponseEntry& response,
                                   const case_data::Case& result) {
  if (table.has("scale")) {
    return constant_above(context, table, "scale", 0.0, 1.0);
  }
  if (response.kind == case_data::ResponseKind::VonMisesKs &&
      context.bodies_good && !any_yields(result)) {
    context.problems.add(
        table.line(),
        fmt::format("{} has no 'scale', and no body's material a "
                    "yield_strength to take in its place; add scale = STRESS "
                    "here, or yield_strength to the material",
                    table.path()));
  }
  return std::nullopt;
}

/// Over the case's names and the responses above this one.
case_data::Quantity read_value(CaseContext& context, const CaseTable& table,
                               const case_data::Case& result) {
  const std::size_t own = context.names.size();
  for (const case_data::ResponseEntry& response : result.responses) {
    const bool taken = std::find(context.names.begin(), context.names.end(),
                                 response.name) != context.names.end();
    // A name of the case hides a response of that name.
    context.names.push_back(taken ? "" : response.name);
    context.measures.emplace_back();  // weighted sums of them are usual
  }
  case_data::Quantity value = table.quantity_or_zero("value");
  for (const int name : value.expression.names_used()) {
    const std::string& used = context.names[static_cast<std::size_t>(name)];
    if (static_cast<std::size_t>(name) < own &&
        std::any_of(result.responses.begin(), result.responses.end(),
                    [&](const case_data::ResponseEntry& response) {
                      return response.name == used;
                    })) {
      context.problems.warn(
          value.line,
          fmt::format("{} takes '{}' of the case, not the response of that "
                      "name; call one of the two otherwise",
                      value.key, used));
    }
  }
  std::vector<Measure> measures = context.measures;
  context.names.resize(own);
  context.measures.resize(own);
  for (std::size_t k = 0; k < result.responses.size(); ++k) {
    measures[own + k] = case_data::measure_of(result.responses[k]);
  }
  try {
    value.measure = measure_of(value.expression, measures);
  } catch (const ExpressionError&) {
    value.measure = {};  // such a sum: what it measures is its author's
  }
  return value;
}

/// The region of a distance, and how smooth extremes over places are.
void read_place(CaseContext& context, const CaseTable& table,
                case_data::ResponseEntry& response) {
  if (table.has("smoothing")) {
    response.smoothing = constant_above(context, table, "smoothing", 0.0, 1.0);
  }
  if (response.kind != case_data::ResponseKind::Distance) {
    return;
  }
  if (table.has("keep_out") == table.has("keep_in")) {
    context.problems.add(
        table.line(),
        fmt::format("{} has {} of keep_out and keep_in; expected one, an "
                    "expression of x, y, z that is above 0 in the region",
                    table.path(), table.has("keep_in") ? "both" : "none"));
    return;
  }
  response.side = table.has("keep_in") ? case_data::RegionSide::KeepIn
                                       : case_data::RegionSide::KeepOut;
  response.region =
      table.place_quantity(table.has("keep_in") ? "keep_in" : "keep_out");
}

/// Bytes of a scan belong to the case, by their fingerprint: scans are large.
void keep_scan(CaseContext& context, const CaseTable& table,
               const std::string& scan, case_data::Case& result) {
  const auto known = std::any_of(
      result.files.begin(), result.files.end(),
      [&](const case_data::CaseFile& file) { return file.path == scan; });
  if (known) {
    return;
  }
  const std::filesystem::path path = case_data::scan_path(result, scan);
  const std::string ending = path.extension().string();
  if (ending != ".stl" && ending != ".obj" && ending != ".STL") {
    context.problems.add(
        table.line("scan"),
        fmt::format("{}.scan is '{}'; expected a file that ends in .stl or "
                    ".obj",
                    table.path(), scan));
  } else if (!std::filesystem::is_regular_file(path)) {
    context.problems.add(
        table.line("scan"),
        fmt::format("{}.scan: there is no file '{}'; expected an STL or OBJ "
                    "file, its path relative to the case",
                    table.path(), path.string()));
  } else {
    try {
      result.files.push_back({scan, files::content_hash(read_file(path))});
    } catch (const IoError& error) {
      context.problems.add(table.line("scan"), error.what());
    }
  }
}

/// Films of a gap, or of a distance to a scan.
void read_response_films(CaseContext& context, const CaseTable& table,
                         const case_data::Case& result,
                         case_data::ResponseEntry& response) {
  const std::vector<std::string> known = case_data::film_names(result);
  response.films = table.names("films");
  for (const std::string& film : response.films) {
    if (std::find(known.begin(), known.end(), film) == known.end()) {
      context.problems.unknown(table.line("films"), "film", film, known);
    }
  }
  if (response.kind == case_data::ResponseKind::Gap && table.has("films") &&
      (response.films.size() != 2 || response.films[0] == response.films[1])) {
    context.problems.add(
        table.line("films"),
        fmt::format("{}.films has [{}]; a gap is between two films",
                    table.path(), fmt::join(response.films, ", ")));
  }
  if (response.kind == case_data::ResponseKind::ScanDistance &&
      response.films.empty()) {
    response.films = known;
  }
}

/// What only liquid has; parts of plane faces may have none.
void require_films(CaseContext& context, const CaseTable& table,
                   const case_data::ResponseRow& row,
                   const case_data::Case& result) {
  if (result.films.empty() && row.of_films) {
    context.problems.add(
        table.line("kind"),
        fmt::format("{} is a {}, and the case has no films; take it out, or "
                    "add [films.NAME]",
                    table.path(), row.name));
  }
}

/// How steep a surface may be.
void read_facing(CaseContext& context, const CaseTable& table,
                 const case_data::Case& result,
                 case_data::ResponseEntry& response) {
  constexpr double kDegree = 0.017453292519943295;
  constexpr double kRight = 90.0 * kDegree;
  const bool overhang = response.kind == case_data::ResponseKind::Overhang;
  if (!overhang && response.kind != case_data::ResponseKind::Draft) {
    return;
  }
  const double usual = (overhang ? 45.0 : 2.0) * kDegree;
  const double part = overhang ? 0.1 : 0.5;
  response.angle = table.constant("angle").value_or(usual);
  response.width = table.constant("width").value_or(part * response.angle);
  if (!(response.angle > 0.0) || !(response.angle < kRight)) {
    context.problems.add(
        table.line("angle"),
        fmt::format("{}.angle is {:g} degrees; expected one above 0 and below "
                    "90, with its unit, as \"{:g} deg\"",
                    table.path(), response.angle / kDegree, usual / kDegree));
  } else if (!(response.width > 0.0) || !(response.width < response.angle)) {
    context.problems.add(
        table.line("width"),
        fmt::format("{}.width is {:g} degrees; expected a part of the angle, "
                    "{:g} degrees, with its unit, as \"{:.3g} deg\"",
                    table.path(), response.width / kDegree,
                    response.angle / kDegree, part * response.angle / kDegree));
  }
  const std::vector<std::string> known = case_data::surface_names(result);
  response.base = table.names("base");
  for (const std::string& surface : response.base) {
    if (std::find(known.begin(), known.end(), surface) == known.end()) {
      context.problems.unknown(table.line("base"), "surface", surface, known);
    }
  }
}

/// Which of the modes, and where its part is held.
void read_mode(CaseContext& context, const CaseTable& table,
               const case_data::Case& result,
               case_data::ResponseEntry& response) {
  constexpr int kMost = case_data::AnalysisEntry::kMostModes;
  const bool of_frequency = response.kind == case_data::ResponseKind::Frequency;
  if (!of_frequency &&
      response.kind != case_data::ResponseKind::BucklingFactor) {
    return;
  }
  if (of_frequency) {
    response.load_case =
        table.has("load_case")
            ? index_of_held(context, table, result, "load_case")
            : result.analysis.supports_of;
  }
  if (result.analysis.solver == equations::SolverKind::Distributed) {
    context.problems.add(
        table.line("kind"),
        fmt::format("{} needs the matrix in one process, and analysis.solver "
                    "= \"petsc\" spreads it; choose another solver or take "
                    "it out",
                    table.path()));
  }
  response.number = table.integer_within("number", 1, kMost).value_or(1);
  const bool first = response.number == 1;
  const double usual = first ? kUsualCluster : 0.0;
  response.cluster = table.constant("cluster").value_or(usual);
  if (!(response.cluster >= 0.0 && response.cluster < 1.0)) {
    context.problems.add(
        table.line("cluster"),
        fmt::format("{}.cluster is {:g}; it must be from 0 to below 1; {:g} "
                    "when left out",
                    table.path(), response.cluster, usual));
    response.cluster = usual;
  } else if (!first && response.cluster > 0.0) {
    context.problems.add(
        table.line("cluster"),
        fmt::format("{}.cluster is of the lowest modes, and number is {}; "
                    "take one of the two out",
                    table.path(), response.number));
    response.cluster = 0.0;
  }
}

case_data::ResponseEntry read_response(CaseContext& context,
                                       const CaseTable& table,
                                       const case_data::ResponseRow& row,
                                       const case_data::Case& result) {
  case_data::ResponseEntry response;
  response.name = table.name();
  response.line = table.line();
  response.kind = row.kind;
  table.check_kind(row.name, row.keys);
  require_films(context, table, row, result);
  response.surface = surface_on(context, table, result);
  response.direction = table.vector_or_zero(
      case_data::needs_key(row, "axis") ? "axis" : "direction");
  const std::vector<std::string>& optional = row.keys.optional;
  if (row.kind != case_data::ResponseKind::Frequency &&
      std::find(optional.begin(), optional.end(), "load_case") !=
          optional.end()) {
    response.load_case = index_of_load_case(context, table, result);
  }
  if (table.has("through")) {
    response.point = table.vector_or_zero("through");
  }
  read_mode(context, table, result, response);
  response.weight = table.place_quantity("weight");
  response.power = read_power(context, table, response);
  response.sharpness =
      constant_above(context, table, "sharpness", 0.0, response.sharpness);
  response.scale = stress_scale(context, table, response, result);
  read_place(context, table, response);
  if (const auto film = table.text("film")) {
    response.film = *film;
    index_among(context, table, "film", case_data::film_names(result));
  }
  read_response_films(context, table, result, response);
  if (response.kind == case_data::ResponseKind::ScanDistance) {
    response.measure = read_named(context, table, "measure", scan_measures());
  }
  read_facing(context, table, result, response);
  read_strength(context, table, result, response);
  response.scan = table.text("scan").value_or("");
  response.body =
      index_among(context, table, "body", case_data::body_names(result));
  if (response.kind == case_data::ResponseKind::Expression) {
    response.value = read_value(context, table, result);
  }
  if (takes_load_case(response) &&
      response.kind != case_data::ResponseKind::Frequency &&
      !table.has("load_cases")) {
    const auto asked = asked_case(result, table.text("load_case"));
    if (asked) {  // else it has been noted
      ask(context, table.line("load_case"), *asked, response);
    }
  }
  return response;
}

}  // namespace

/// The load case that `key` names; the first when left out or wrong.
int index_of_load_case(CaseContext& context, const CaseTable& table,
                       const case_data::Case& result, const char* key) {
  const auto wanted = table.text(key);
  if (!wanted) {
    return 0;
  }
  if (const auto asked = asked_case(result, wanted)) {
    return asked->load_case;
  }
  std::vector<std::string> known;
  for (const AskedCase& asked : asked_cases(result)) {
    known.push_back(asked.name);
  }
  context.problems.unknown(table.line(key), "load case", *wanted, known);
  return 0;
}

std::vector<AskedCase> asked_cases(const case_data::Case& result) {
  std::vector<AskedCase> asked;
  for (int k = 0; k < static_cast<int>(result.load_cases.size()); ++k) {
    const auto from_any =
        case_data::directions_with(result, static_cast<std::size_t>(k));
    if (from_any == result.directions.end()) {
      asked.push_back({.name = result.load_cases[k].name, .load_case = k});
    } else {
      asked.push_back({from_any->name, k, from_any->cone});
      k += 2;
    }
  }
  return asked;
}

std::optional<AskedCase> asked_case(const case_data::Case& result,
                                    const std::optional<std::string>& name) {
  for (const AskedCase& asked : asked_cases(result)) {
    if (!name || asked.name == *name) {
      return asked;
    }
  }
  for (int k = 0; k < static_cast<int>(result.load_cases.size()); ++k) {
    if (result.load_cases[k].name == *name) {
      return AskedCase{.name = *name, .load_case = k};
    }
  }
  return std::nullopt;
}

void ask(CaseContext& context, case_data::SourceLine line,
         const AskedCase& asked, case_data::ResponseEntry& response) {
  response.load_case = asked.load_case;
  response.worst_in = asked.worst_in;
  if (asked.worst_in && !case_data::knows_worst_direction(response)) {
    context.problems.add(
        line,
        fmt::format("responses.{} is of load case '{}', whose load comes from "
                    "any direction; its kind knows no worst one: "
                    "mean_displacement, rotation, compliance, strain_energy "
                    "and stress_ratio of von Mises stress do. Ask it of the "
                    "unit loads '{}_x', '{}_y' and '{}_z' instead, or of a "
                    "load case with 'force'",
                    response.name, asked.name, asked.name, asked.name,
                    asked.name));
  }
}

int index_of_held(CaseContext& context, const CaseTable& table,
                  const case_data::Case& result, const char* key) {
  const auto is_free = [](const case_data::LoadCaseEntry& entry) {
    return entry.name == "free";
  };
  if (table.text(key) == "free" &&
      std::none_of(result.load_cases.begin(), result.load_cases.end(),
                   is_free)) {
    return case_data::AnalysisEntry::kFree;
  }
  return index_of_load_case(context, table, result, key);
}

void read_responses(CaseContext& context, const toml::table& root,
                    case_data::Case& result) {
  for (const CaseTable& table : named_tables(context, root, "responses")) {
    if (const auto kind = table.choice("kind")) {
      const case_data::ResponseRow& row =
          case_data::row_named(case_data::response_kinds(), *kind);
      case_data::ResponseEntry response =
          read_response(context, table, row, result);
      if (!response.scan.empty()) {
        keep_scan(context, table, response.scan, result);
      }
      add_response(context, table, std::move(response), result);
    }
  }
}

}  // namespace meniscus::reader
