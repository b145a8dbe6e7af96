#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus {

namespace {

void note(CaseContext& context, const CaseTable& table, const char* key,
          const std::string& what) {
  context.problems.add(table.line(key),
                       fmt::format("{}.{} {}", table.path(), key, what));
}

void read_fix(CaseContext& context, const CaseTable& table, Support& support) {
  const auto fix = table.text("fix");
  if (!fix) {
    return;
  }
  if (*fix == "normal" || *fix == "symmetry") {
    support.kind =
        *fix == "normal" ? SupportKind::Normal : SupportKind::Symmetry;
    if (table.has("axes")) {
      note(context, table, "axes",
           fmt::format("does not belong to fix = \"{}\"; take it out", *fix));
    }
    return;
  }
  if (fix->empty() || fix->find_first_not_of("xyz") != std::string::npos) {
    note(context, table, "fix",
         fmt::format("is '{}'; expected some of \"xyz\", or \"normal\" or "
                     "\"symmetry\"",
                     *fix));
  }
  support.fix_x = fix->find('x') != std::string::npos;
  support.fix_y = fix->find('y') != std::string::npos;
  support.fix_z = fix->find('z') != std::string::npos;
  support.axes = table.axes("axes");
}

SpringBed read_springs(CaseContext& context, const CaseTable& table) {
  SpringBed bed;
  bed.components = table.constant_vector("stiffness").value_or(Vec3::Zero());
  bed.normal = table.constant("normal_stiffness").value_or(0.0);
  bed.axes = table.axes("axes");
  if (table.choice("stiffness_of") == "total") {
    bed.measure = SpringMeasure::Total;
  }
  if (bed.components.minCoeff() < 0.0 || bed.normal < 0.0 ||
      (bed.components.isZero(0.0) && bed.normal == 0.0)) {
    context.problems.add(
        table.line(),
        fmt::format("{} on springs: stiffnesses are 0 or above, one of them "
                    "above",
                    table.path()));
  }
  return bed;
}

void read_support(CaseContext& context, const CaseTable& table,
                  const Case& result, LoadCaseEntry& load_case) {
  const std::string surface = surface_on(context, table, result);
  const bool springs = table.has("stiffness") || table.has("normal_stiffness");
  if (table.has("fix") == springs) {
    context.problems.add(
        table.line(),
        fmt::format(
            "{} on '{}' has {}; expected one of fix and stiffness or "
            "normal_stiffness",
            table.path(), surface,
            springs ? "both fix and springs" : "neither fix nor springs"));
  } else if (springs) {
    SpringBed bed = read_springs(context, table);
    bed.surface = surface;
    load_case.springs.push_back(std::move(bed));
  } else {
    Support support{.surface = surface};
    read_fix(context, table, support);
    load_case.supports.push_back(std::move(support));
  }
}

/// What belongs to a load beside its own key.
struct LoadKeys {
  LoadKind kind;
  bool on_surface;
  std::vector<std::string> optional;
};

const std::map<std::string, LoadKeys>& load_keys() {
  static const std::map<std::string, LoadKeys> keys = {
      {"force", {LoadKind::Force, true, {"at", "moment"}}},
      {"moment", {LoadKind::Remote, true, {"at", "force"}}},
      {"pressure", {LoadKind::Pressure, true, {}}},
      {"traction", {LoadKind::Traction, true, {}}},
      {"gravity", {LoadKind::Gravity, false, {}}},
      {"spin", {LoadKind::Spin, false, {"at", "axis"}}},
      {"temperature", {LoadKind::Temperature, false, {"reference"}}}};
  return keys;
}

/// The load's key: force before moment; empty, and a note, when it is not one.
std::string load_key(CaseContext& context, const CaseTable& table,
                     const std::string& surface) {
  std::vector<std::string> found;
  for (const auto& [key, keys] : load_keys()) {
    if (table.has(key.c_str()) && !(key == "moment" && table.has("force"))) {
      found.push_back(key);
    }
  }
  if (found.size() == 1) {
    return found.front();
  }
  context.problems.add(
      table.line(),
      fmt::format(
          "{}{} has {}; expected one of force, moment, pressure, "
          "traction, gravity, spin, temperature",
          table.path(), surface.empty() ? "" : fmt::format(" on '{}'", surface),
          found.empty() ? "no load"
                        : fmt::format("{}", fmt::join(found, " and "))));
  return "";
}

void check_load_keys(CaseContext& context, const CaseTable& table,
                     const std::string& key) {
  const LoadKeys& keys = load_keys().at(key);
  if (keys.on_surface && !table.has("on")) {
    context.problems.add(table.line(),
                         fmt::format("{} is a {} and has no 'on' (the surface "
                                     "that is loaded); add it",
                                     table.path(), key));
  }
  for (const char* other : {"on", "at", "axis", "reference"}) {
    const bool belongs =
        std::string(other) == "on"
            ? keys.on_surface
            : std::find(keys.optional.begin(), keys.optional.end(), other) !=
                  keys.optional.end();
    if (table.has(other) && !belongs) {
      note(context, table, other,
           fmt::format("does not belong to a {}; take it out", key));
    }
  }
  const bool through_point =
      key == "spin" || (key == "force" && table.has("moment"));
  if (through_point && !table.has("at")) {
    context.problems.add(
        table.line(),
        fmt::format("{} has a {} and no 'at' (a point); add it", table.path(),
                    key == "spin" ? "spin" : "force with a moment"));
  }
  if (key == "spin" && !table.has("axis")) {
    context.problems.add(
        table.line(),
        fmt::format("{} has a spin and no 'axis'; add it", table.path()));
  }
}

void read_load(CaseContext& context, const CaseTable& table, const Case& result,
               LoadCaseEntry& load_case) {
  LoadEntry load{.surface = surface_on(context, table, result),
                 .line = table.line()};
  const std::string key = load_key(context, table, load.surface);
  if (key.empty()) {
    return;
  }
  check_load_keys(context, table, key);
  load.kind = load_keys().at(key).kind;
  if (key == "force" && (table.has("at") || table.has("moment"))) {
    load.kind = LoadKind::Remote;
  }
  load.at = table.vector_or_zero("at");
  load.moment = table.vector_or_zero("moment");
  load.vector = table.vector_or_zero(load.kind == LoadKind::Gravity ? "gravity"
                                     : load.kind == LoadKind::Spin  ? "axis"
                                                                    : "force");
  load.place =
      table
          .place_quantity(load.kind == LoadKind::Temperature ? "temperature"
                                                             : "pressure")
          .value_or(PlaceQuantity{});
  if (auto traction = table.place_vector("traction")) {
    load.traction = *std::move(traction);
  }
  load.number = table.quantity_or_zero(
      load.kind == LoadKind::Spin ? "spin" : "reference");
  load_case.loads.push_back(std::move(load));
}

}  // namespace

std::string surface_on(CaseContext& context, const CaseTable& table,
                       const Case& result, const char* key) {
  std::string surface = table.text(key).value_or("");
  if (!table.has(key)) {
    return surface;
  }
  const std::vector<std::string> known = surface_names(result);
  int bodies = 0;
  int solid = 0;
  for (const BodyEntry& body : result.bodies) {
    const int one = static_cast<int>(
        std::count(body.enclosed_by.begin(), body.enclosed_by.end(), surface));
    bodies += one;
    solid += body.material == kVoid ? 0 : one;
  }
  for (const WallEntry& wall : result.walls) {
    for (const std::string& film : wall.films) {
      solid += film == surface || surface.starts_with(film + "/") ? 1 : 0;
    }
  }
  if (std::find(known.begin(), known.end(), surface) == known.end()) {
    context.problems.unknown(table.line(key), "surface", surface, known);
  } else if (context.bodies_good && solid == 0) {
    context.problems.add(
        table.line(key),
        fmt::format("surface '{}' encloses no {}, so nothing can act on it; "
                    "add it to a body's enclosed_by",
                    surface, bodies == 0 ? "body" : "material, only voids"));
  }
  return surface;
}

void read_load_cases(CaseContext& context, const toml::table& root,
                     Case& result) {
  for (const CaseTable& table : named_tables(context, root, "load_cases")) {
    LoadCaseEntry load_case{.name = table.name(), .line = table.line()};
    for (const CaseTable& support : table.tables("supports", "support")) {
      read_support(context, support, result, load_case);
    }
    for (const CaseTable& load : table.tables("loads", "load")) {
      read_load(context, load, result, load_case);
    }
    result.load_cases.push_back(std::move(load_case));
  }
}

}  // namespace meniscus
