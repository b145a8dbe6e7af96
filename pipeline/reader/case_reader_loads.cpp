#include <algorithm>
#include <array>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/case_loads.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

void note(CaseContext& context, const CaseTable& table, const char* key,
          const std::string& what) {
  context.problems.add(table.line(key),
                       fmt::format("{}.{} {}", table.path(), key, what));
}

/// Some of "xyz"; notes what else there is.
std::array<bool, 3> components_of(CaseContext& context, const CaseTable& table,
                                  const char* key, const char* expected) {
  const std::string text = table.text(key).value_or("");
  if (table.has(key) && table.text(key) &&
      (text.empty() || text.find_first_not_of("xyz") != std::string::npos)) {
    note(context, table, key,
         fmt::format("is '{}'; expected some of {}", text, expected));
  }
  return {text.find('x') != std::string::npos,
          text.find('y') != std::string::npos,
          text.find('z') != std::string::npos};
}

void refuse_foreign(CaseContext& context, const CaseTable& table,
                    const std::vector<const char*>& keys,
                    const std::string& what) {
  for (const char* key : keys) {
    if (table.has(key)) {
      note(context, table, key,
           fmt::format("does not belong to {}; take it out", what));
    }
  }
}

void read_fix(CaseContext& context, const CaseTable& table,
              case_data::SupportEntry& entry) {
  loads::Support& support = entry.support;
  const auto fix = table.text("fix");
  entry.at = table.vector("at");
  entry.rotation = table.vector("rotation");
  support.fix_rotation =
      components_of(context, table, "fix_rotation", "\"xyz\"");
  if (!fix) {
    support.axes = table.axes("axes");
    return;
  }
  if (*fix == "normal" || *fix == "symmetry") {
    support.kind = *fix == "normal" ? loads::SupportKind::Normal
                                    : loads::SupportKind::Symmetry;
    refuse_foreign(context, table, {"axes", "displacement"},
                   fmt::format("fix = \"{}\"", *fix));
    return;
  }
  const auto fixed = components_of(context, table, "fix",
                                   "\"xyz\", or \"normal\" or \"symmetry\"");
  support.fix_x = fixed[0];
  support.fix_y = fixed[1];
  support.fix_z = fixed[2];
  support.axes = table.axes("axes");
  entry.displacement = table.vector("displacement");
}

case_data::PinEntry read_pin(CaseContext& context, const CaseTable& table,
                             const loads::Surfaces& surfaces) {
  case_data::PinEntry entry{.pin = {.surfaces = surfaces},
                            .line = table.line()};
  entry.pin.fix = components_of(context, table, "fix", "\"xyz\"");
  entry.pin.fix_rotation =
      components_of(context, table, "fix_rotation", "\"xyz\"");
  entry.pin.axes = table.axes("axes");
  entry.at = table.vector_or_zero("at");
  entry.displacement = table.vector("displacement");
  entry.rotation = table.vector("rotation");
  if (!table.has("at")) {
    context.problems.add(
        table.line(),
        fmt::format("{} on '{}' is rigid and has no 'at' (the point that is "
                    "held); add it",
                    table.path(), surfaces.text()));
  }
  return entry;
}

loads::SpringBed read_springs(CaseContext& context, const CaseTable& table) {
  loads::SpringBed bed;
  Dimension dimension = Dimension::Foundation;
  if (table.choice("stiffness_of") == "total") {
    bed.measure = loads::SpringMeasure::Total;
    dimension = Dimension::Tension;  // force per length
  }
  bed.components =
      table.constant_vector("stiffness", dimension).value_or(Vec3::Zero());
  bed.normal = table.constant("normal_stiffness", dimension).value_or(0.0);
  bed.axes = table.axes("axes");
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
                  const case_data::Case& result,
                  case_data::LoadCaseEntry& load_case) {
  const loads::Surfaces surfaces = surfaces_on(context, table, result);
  const bool springs = table.has("stiffness") || table.has("normal_stiffness");
  const bool rigid = table.choice("by") == "rigid";
  const bool turns = rigid || !result.shells.empty();
  const bool fixes = table.has("fix") || (turns && table.has("fix_rotation"));
  if (fixes == springs) {
    context.problems.add(
        table.line(),
        fmt::format(
            "{} on '{}' has {}; expected one of fix{} and stiffness or "
            "normal_stiffness",
            table.path(), surfaces.text(),
            springs ? "both fix and springs" : "neither fix nor springs",
            turns ? ", fix_rotation" : ""));
  } else if (springs) {
    refuse_foreign(context, table,
                   {"by", "displacement", "at", "fix_rotation", "rotation"},
                   "springs");
    loads::SpringBed bed = read_springs(context, table);
    if (surfaces.size() > 1 && bed.measure == loads::SpringMeasure::Total) {
      note(context, table, "stiffness_of",
           "is total on several surfaces; give each an entry with its share");
    }
    for (const std::string& surface : surfaces) {
      bed.surface = surface;
      load_case.springs.push_back(bed);
    }
  } else if (rigid) {
    load_case.pins.push_back(read_pin(context, table, surfaces));
  } else {
    case_data::SupportEntry entry;
    entry.line = table.line();
    read_fix(context, table, entry);
    if (!turns) {
      refuse_foreign(context, table, {"at", "fix_rotation", "rotation"},
                     "a support by nodes (by = \"rigid\" and shells have it)");
    }
    for (const std::string& surface : surfaces) {
      entry.support.surface = surface;
      load_case.supports.push_back(entry);
    }
  }
}

/// A surface is of one rigid pin, and of no support beside it.
void check_pins(CaseContext& context,
                const case_data::LoadCaseEntry& load_case) {
  struct Use {
    loads::Surfaces surfaces;
    bool support;
    case_data::SourceLine line;
  };
  std::vector<Use> uses;
  for (const case_data::PinEntry& pin : load_case.pins) {
    uses.push_back({pin.pin.surfaces, true, pin.line});
  }
  for (const case_data::LoadEntry& load : load_case.loads) {
    if (load.by == case_data::LoadPath::Rigid) {
      uses.push_back({load.surfaces, false, load.line});
    }
  }
  for (std::size_t a = 0; a < uses.size(); ++a) {
    for (const std::string& surface : uses[a].surfaces) {
      for (std::size_t b = 0; b < a; ++b) {
        const loads::Surfaces& other = uses[b].surfaces;
        const bool shared =
            std::find(other.begin(), other.end(), surface) != other.end();
        if (shared && (!case_data::are_same_surfaces(other, uses[a].surfaces) ||
                       (uses[a].support && uses[b].support))) {
          context.problems.add(
              uses[a].line,
              fmt::format("surface '{}' is of two rigid pins of load case "
                          "'{}'; name the same surfaces in both, and hold "
                          "them in one entry",
                          surface, load_case.name));
        }
      }
      for (const case_data::SupportEntry& support : load_case.supports) {
        if (support.support.surface == surface) {
          context.problems.add(
              support.line,
              fmt::format("surface '{}' is of a rigid pin of load case '{}' "
                          "and held by nodes; give the support by = \"rigid\", "
                          "too",
                          surface, load_case.name));
        }
      }
    }
  }
}

/// A load has the key of its name, and what belongs to that.
struct LoadRow {
  const char* name;
  case_data::LoadKind kind;
  bool on_surface;
  std::vector<std::string> optional;
};

const std::vector<LoadRow>& load_kinds() {
  static const std::vector<LoadRow> kinds = {
      {"force",
       case_data::LoadKind::Force,
       true,
       {"at", "moment", "by", "axis"}},
      {"moment", case_data::LoadKind::Remote, true, {"at", "force", "by"}},
      {"size",
       case_data::LoadKind::Force,
       true,
       {"at", "by", "within", "about"}},
      {"pressure", case_data::LoadKind::Pressure, true, {}},
      {"traction", case_data::LoadKind::Traction, true, {}},
      {"rim_tension", case_data::LoadKind::RimTension, true, {}},
      {"gravity", case_data::LoadKind::Gravity, false, {}},
      {"spin", case_data::LoadKind::Spin, false, {"at", "axis"}},
      {"temperature", case_data::LoadKind::Temperature, false, {"reference"}}};
  return kinds;
}

std::vector<std::string> load_names(bool on_surface) {
  std::vector<std::string> names;
  for (const LoadRow& row : load_kinds()) {
    if (row.on_surface == on_surface) {
      names.emplace_back(row.name);
    }
  }
  return names;
}

/// The load's key: force before moment; empty, and a note, when it is not one.
std::string load_key(CaseContext& context, const CaseTable& table,
                     const loads::Surfaces& surfaces) {
  std::vector<std::string> found;
  for (const LoadRow& row : load_kinds()) {
    if (table.has(row.name) &&
        !(row.kind == case_data::LoadKind::Remote && table.has("force"))) {
      found.emplace_back(row.name);
    }
  }
  std::sort(found.begin(), found.end());
  if (found.size() == 1) {
    return found.front();
  }
  context.problems.add(
      table.line(),
      fmt::format(
          "{}{} has {}; expected one of {}", table.path(),
          surfaces.empty() ? "" : fmt::format(" on '{}'", surfaces.text()),
          found.empty() ? "no load"
                        : fmt::format("{}", fmt::join(found, " and ")),
          fmt::join(split_choices(case_data::choices_of(load_kinds())), ", ")));
  return "";
}

void check_load_keys(CaseContext& context, const CaseTable& table,
                     const std::string& key) {
  const LoadRow& row = case_data::row_named(load_kinds(), key);
  if (row.on_surface && !table.has("on")) {
    context.problems.add(table.line(),
                         fmt::format("{} is a {} and has no 'on' (the surface "
                                     "that is loaded); add it",
                                     table.path(), key));
  }
  const auto is_kind = [](const std::string& name) {
    return std::any_of(load_kinds().begin(), load_kinds().end(),
                       [&](const LoadRow& kind) { return name == kind.name; });
  };
  for (const KeySpec& spec : load_table().keys) {
    const std::string other = spec.key;
    const bool belongs =
        other == "on" ? row.on_surface
                      : std::find(row.optional.begin(), row.optional.end(),
                                  other) != row.optional.end();
    if (!is_kind(other) && !belongs && table.has(spec.key)) {
      note(context, table, spec.key,
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

/// A part spins about one axis and has one temperature: a second is no sum.
void refuse_second(CaseContext& context, const CaseTable& table,
                   const std::string& key, case_data::LoadKind kind,
                   const case_data::LoadCaseEntry& load_case) {
  const bool single = kind == case_data::LoadKind::Spin ||
                      kind == case_data::LoadKind::Temperature;
  const auto first = std::find_if(
      load_case.loads.begin(), load_case.loads.end(),
      [kind](const case_data::LoadEntry& load) { return load.kind == kind; });
  if (single && first != load_case.loads.end()) {
    note(context, table, key.c_str(),
         fmt::format("is the second {} of its load case, after that of line "
                     "{}; keep one",
                     key, first->line));
  }
}

case_data::LoadPath load_path(CaseContext& context, const CaseTable& table,
                              const std::string& key) {
  const std::string by = table.choice("by").value_or("spread");
  if (by != "bearing") {
    if (key == "force") {
      refuse_foreign(context, table, {"axis"}, "a force that is " + by);
    }
    return by == "rigid" ? case_data::LoadPath::Rigid
                         : case_data::LoadPath::Spread;
  }
  if (key == "moment") {
    note(context, table, "by",
         "is bearing: a pin that presses carries a force, no moment alone");
  }
  refuse_foreign(context, table, {"moment"}, "a force that is bearing");
  return case_data::LoadPath::Bearing;
}

/// What directions a load of given size may come from; all without the keys.
Cone read_cone(CaseContext& context, const CaseTable& table) {
  constexpr double kHalfTurn = std::numbers::pi;
  Cone cone{.half_angle = kHalfTurn};
  if (table.has("within") != table.has("about")) {
    context.problems.add(
        table.line(),
        fmt::format("{} has one of 'within' and 'about'; a cone of directions "
                    "needs both, as within = \"30 deg\", about = [0, 0, 1]; "
                    "without them the load comes from any direction",
                    table.path()));
    return cone;
  }
  cone.half_angle = table.constant("within").value_or(kHalfTurn);
  if (!(cone.half_angle >= 0.0 && cone.half_angle <= kHalfTurn)) {
    note(context, table, "within",
         fmt::format("is {:g} degrees; expected the angle between the load and "
                     "'about', from 0 to 180, with its unit, as \"30 deg\"",
                     cone.half_angle * 180.0 / kHalfTurn));
  }
  const Vec3 axis = table.constant_vector("about").value_or(Vec3::UnitZ());
  if (axis.norm() > 0.0) {
    cone.axis = axis.normalized();
  } else {
    note(context, table, "about", "has no length; give a direction");
  }
  return cone;
}

/// A load case of a load from any direction is three, along x, y and z.
void add_load_case(CaseContext& context, const CaseTable& table,
                   case_data::LoadCaseEntry load_case,
                   case_data::Case& result) {
  const auto from_any =
      std::find_if(load_case.loads.begin(), load_case.loads.end(),
                   [](const case_data::LoadEntry& l) { return bool(l.size); });
  if (from_any == load_case.loads.end()) {
    result.load_cases.push_back(std::move(load_case));
    return;
  }
  const case_data::LoadEntry load = *from_any;
  const bool enforces =
      std::any_of(load_case.supports.begin(), load_case.supports.end(),
                  [](const auto& s) { return s.displacement || s.rotation; }) ||
      std::any_of(load_case.pins.begin(), load_case.pins.end(),
                  [](const auto& p) { return p.displacement || p.rotation; });
  if (load_case.loads.size() > 1 || enforces) {
    context.problems.add(
        load.line,
        fmt::format("load case '{}' has a load from any direction beside {}; "
                    "such a load acts alone: give it a load case of its own",
                    load_case.name,
                    enforces ? "an enforced displacement" : "another load"));
  }
  if (load.by == case_data::LoadPath::Bearing) {
    context.problems.add(
        load.line,
        fmt::format("{}: which half of a bore a pin presses against turns "
                    "with its force, so that a bearing's unit loads do not add "
                    "up; take by = \"bearing\" out or give 'force'",
                    table.path()));
  }
  result.directions.push_back(
      {.name = load_case.name,
       .first = static_cast<int>(result.load_cases.size()),
       .cone = load.cone});
  for (std::size_t k = 0; k < 3; ++k) {
    case_data::LoadCaseEntry along = load_case;
    along.name = fmt::format("{}_{}", load_case.name, "xyz"[k]);
    along.loads = {load};
    along.loads.front().vector = {};
    along.loads.front().vector[k] = *load.size;
    if (k > 0) {
      along.loads.front().size.reset();  // checked once
    }
    result.load_cases.push_back(std::move(along));
  }
}

void check_load_case_names(CaseContext& context,
                           const case_data::Case& result) {
  for (std::size_t a = 0; a < result.load_cases.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (result.load_cases[a].name == result.load_cases[b].name) {
        context.problems.add(
            result.load_cases[a].line,
            fmt::format("load case '{}' has the name of a unit load of a load "
                        "from any direction; give it another",
                        result.load_cases[a].name));
      }
    }
  }
}

void read_load(CaseContext& context, const CaseTable& table,
               const case_data::Case& result,
               case_data::LoadCaseEntry& load_case) {
  case_data::LoadEntry load{.surfaces = surfaces_on(context, table, result),
                            .line = table.line()};
  const std::string key = load_key(context, table, load.surfaces);
  if (key.empty()) {
    return;
  }
  check_load_keys(context, table, key);
  load.kind = case_data::row_named(load_kinds(), key).kind;
  refuse_second(context, table, key, load.kind, load_case);
  if ((key == "force" || key == "size") &&
      (table.has("at") || table.has("moment"))) {
    load.kind = case_data::LoadKind::Remote;
  }
  if (key == "size") {
    load.size = table.quantity_or_zero("size");
    load.cone = read_cone(context, table);
  }
  load.by = load_path(context, table, key);
  load.has_at = table.has("at");
  if (load.by == case_data::LoadPath::Bearing) {
    load.axis = table.vector("axis");
  }
  load.at = table.vector_or_zero("at");
  load.moment = table.vector_or_zero("moment");
  load.vector =
      table.vector_or_zero(load.kind == case_data::LoadKind::Gravity ? "gravity"
                           : load.kind == case_data::LoadKind::Spin  ? "axis"
                                                                     : "force");
  load.place = table
                   .place_quantity(load.kind == case_data::LoadKind::Temperature
                                       ? "temperature"
                                       : "pressure")
                   .value_or(case_data::PlaceQuantity{});
  if (auto traction = table.place_vector("traction")) {
    load.traction = *std::move(traction);
  }
  load.number = table.quantity_or_zero(
      load.kind == case_data::LoadKind::Spin         ? "spin"
      : load.kind == case_data::LoadKind::RimTension ? "rim_tension"
                                                     : "reference");
  if (load.kind == case_data::LoadKind::RimTension && result.shells.empty()) {
    note(
        context, table, "rim_tension",
        "is of [shells]; give the surface of a solid a pressure or a traction");
  }
  load_case.loads.push_back(std::move(load));
}

case_data::LoadEntry read_bolt(CaseContext& context, const CaseTable& table,
                               const case_data::Case& result) {
  case_data::LoadEntry bolt{
      .kind = case_data::LoadKind::Preload,
      .surfaces = surfaces_on(context, table, result, "seat"),
      .thread = surfaces_on(context, table, result, "thread"),
      .vector = table.vector_or_zero("axis"),
      .at = table.vector_or_zero("at"),
      .number = table.quantity_or_zero("preload"),
      .line = table.line()};
  for (const std::string& surface : bolt.surfaces) {
    if (std::find(bolt.thread.begin(), bolt.thread.end(), surface) !=
        bolt.thread.end()) {
      note(context, table, "thread",
           fmt::format("has '{}', which the head is on, too", surface));
    }
  }
  return bolt;
}

}  // namespace

TableSpec bolt_table() {
  using D = Dimension;
  using K = KeyType;
  return {"bolts",
          true,
          TableNeed::Optional,
          "A bolt that is tightened: in every load case its preload presses "
          "into the seat under its head and pulls on its thread, in balance",
          {{"preload", K::Quantity, D::Force, true, "tension in it, above 0"},
           {"seat", K::NameOrNames, D::None, true,
            "surfaces under its head, or a nut"},
           {"thread", K::NameOrNames, D::None, true,
            "surfaces that its thread, or a nut at its other end, pulls on"},
           {"axis", K::Vector, std::nullopt, true,
            "from the thread to the head; any length but 0"},
           {"at", K::Vector, D::Length, true, "a point on its axis"}}};
}

TableSpec load_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "load",
      false,
      TableNeed::Optional,
      fmt::format("A load: {} on a surface, or {} of all bodies",
                  either_of(load_names(true)), either_of(load_names(false))),
      {{"on", K::NameOrNames, D::None, false,
        fmt::format("of {}: the surface that is loaded, or a list: force and "
                    "moment are of all together, pressure, traction and "
                    "rim_tension of each",
                    fmt::join(load_names(true), ", "))},
       {"force", K::Vector, D::Force, false,
        "total, spread as uniform traction; with `at` through that point"},
       {"moment", K::Vector, D::Energy, false,
        "total, beside that of the force"},
       {"size", K::Quantity, D::Force, false,
        "of a force from the worst direction for each response: the only load "
        "of its case"},
       {"within", K::Constant, D::Angle, false,
        "of size: the largest angle between the force and `about`, 0 to 180 "
        "degrees; any direction when both are left out"},
       {"about", K::ConstantVector, std::nullopt, false,
        "of size: the axis of that cone; any length but 0"},
       {"at", K::Vector, D::Length, false,
        "of force and moment: the point they act through; of spin: on the "
        "axis"},
       {"by", K::Choice, D::None, false,
        "how the surfaces take force and moment: spread, without being "
        "stiffened (when left out); rigid, as one rigid body; or bearing, a "
        "force that a round pin presses against one half of its bores",
        "spread|rigid|bearing"},
       {"pressure", K::Place, D::Pressure, false, "positive into the material"},
       {"traction", K::PlaceVector, D::Pressure, false, "force per area"},
       {"rim_tension", K::Quantity, D::Tension, false,
        "of rims of shells: force per length in the film, across its rim and "
        "out of it; below 0 it presses"},
       {"gravity", K::Vector, D::Acceleration, false, "force per mass"},
       {"spin", K::Quantity, D::Rate, false,
        "angular velocity in radians per time"},
       {"axis", K::Vector, std::nullopt, false,
        "of spin and of a bearing force (the bores' own when left out); any "
        "length but 0"},
       {"temperature", K::Place, D::None, false,
        "of all bodies; they expand from the reference"},
       {"reference", K::Quantity, D::None, false,
        "of temperature: where nothing has expanded; 0 when left out"}}};
}

namespace {

/// Films of walls and shells.
std::vector<std::string> films_of_walls(const case_data::Case& input) {
  std::vector<std::string> films;
  for (const case_data::WallEntry& wall : input.walls) {
    films.insert(films.end(), wall.films.begin(), wall.films.end());
  }
  for (const case_data::ShellEntry& shell : input.shells) {
    films.insert(films.end(), shell.films.begin(), shell.films.end());
  }
  return films;
}

bool is_of_wall(const case_data::Case& input, const std::string& film) {
  const std::vector<std::string> films = films_of_walls(input);
  return std::find(films.begin(), films.end(), film) != films.end();
}

/// A wall's sides by where they lie: FILM/outside is FILM, FILM/inside its
/// back, for walls are turned so that their normals point outside.
std::string without_side(const std::string& surface,
                         const case_data::Case& input) {
  for (const auto& [side, ending] :
       {std::pair<std::string, std::string>("/inside", "/back"),
        std::pair<std::string, std::string>("/outside", "")}) {
    const std::string film =
        surface.ends_with(side)
            ? surface.substr(0, surface.size() - side.size())
            : "";
    if (is_of_wall(input, film)) {
      return film + ending;
    }
  }
  return surface;
}

/// The other way around, for messages: sides of walls by where they lie.
std::vector<std::string> with_sides(std::vector<std::string> known,
                                    const case_data::Case& input) {
  constexpr std::string_view kBack = "/back";
  for (std::string& name : known) {
    if (is_of_wall(input, name)) {
      name += "/outside";
    } else if (name.ends_with(kBack)) {  // a lug has one, too
      const std::string film = name.substr(0, name.size() - kBack.size());
      if (is_of_wall(input, film)) {
        name.replace(film.size(), kBack.size(), "/inside");
      }
    }
  }
  return known;
}

}  // namespace

namespace {

/// The surface of that name; notes one that nothing can act on.
std::string known_surface(CaseContext& context, const CaseTable& table,
                          const case_data::Case& result, const char* key,
                          std::string surface) {
  if (!context.surfaces) {
    context.surfaces = case_data::surface_names(result);
  }
  const std::vector<std::string>& known = *context.surfaces;
  surface = without_side(surface, result);
  int bodies = 0;
  int solid = 0;
  for (const case_data::BodyEntry& body : result.bodies) {
    const int one = static_cast<int>(
        std::count(body.enclosed_by.begin(), body.enclosed_by.end(), surface));
    bodies += one;
    solid += body.material == case_data::kVoid ? 0 : one;
  }
  for (const std::string& film : films_of_walls(result)) {
    solid += film == surface || surface.starts_with(film + "/") ? 1 : 0;
  }
  if (std::find(known.begin(), known.end(), surface) == known.end()) {
    context.problems.unknown(table.line(key), "surface", surface,
                             with_sides(known, result));
  } else if (context.bodies_good && solid == 0) {
    context.problems.add(
        table.line(key),
        fmt::format("surface '{}' encloses no {}, so nothing can act on it; "
                    "add it to a body's enclosed_by",
                    surface, bodies == 0 ? "body" : "material, only voids"));
  }
  return surface;
}

}  // namespace

std::string surface_on(CaseContext& context, const CaseTable& table,
                       const case_data::Case& result, const char* key) {
  const std::string surface = table.text(key).value_or("");
  return table.has(key) ? known_surface(context, table, result, key, surface)
                        : surface;
}

loads::Surfaces surfaces_on(CaseContext& context, const CaseTable& table,
                            const case_data::Case& result, const char* key) {
  loads::Surfaces surfaces;
  for (const std::string& name : table.name_or_names(key)) {
    std::string surface = known_surface(context, table, result, key, name);
    if (std::find(surfaces.begin(), surfaces.end(), surface) !=
        surfaces.end()) {
      note(context, table, key, fmt::format("has '{}' twice", name));
    } else {
      surfaces.push_back(std::move(surface));
    }
  }
  return surfaces;
}

void read_load_cases(CaseContext& context, const toml::table& root,
                     case_data::Case& result) {
  std::vector<case_data::LoadEntry> preloads;
  for (const CaseTable& table : named_tables(context, root, "bolts")) {
    preloads.push_back(read_bolt(context, table, result));
  }
  for (const CaseTable& table : named_tables(context, root, "load_cases")) {
    case_data::LoadCaseEntry load_case{.name = table.name(),
                                       .line = table.line()};
    for (const CaseTable& support : table.tables("supports", "support")) {
      read_support(context, support, result, load_case);
    }
    for (const CaseTable& load : table.tables("loads", "load")) {
      read_load(context, load, result, load_case);
    }
    load_case.loads.insert(load_case.loads.end(), preloads.begin(),
                           preloads.end());
    check_pins(context, load_case);
    add_load_case(context, table, std::move(load_case), result);
  }
  check_load_case_names(context, result);
}

}  // namespace meniscus::reader
