#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/heed_stop.h"
#include "io/deck/deck_steps.h"

namespace meniscus::deck {

namespace {

constexpr int kLastRotation = 6;  // components 4 to 6, which solids have not

/// What Abaqus's names hold; solids have no rotations.
std::optional<std::array<bool, 3>> named_support(const std::string& name) {
  static const std::map<std::string, std::array<bool, 3>> kNames = {
      {"ENCASTRE", {true, true, true}}, {"PINNED", {true, true, true}},
      {"XSYMM", {true, false, false}},  {"YSYMM", {false, true, false}},
      {"ZSYMM", {false, false, true}},  {"XASYMM", {false, true, true}},
      {"YASYMM", {true, false, true}},  {"ZASYMM", {true, true, false}}};
  const auto at = kNames.find(name);
  return at == kNames.end() ? std::nullopt : std::optional(at->second);
}

bool alike(const StandingBodyLoad& a, const StandingBodyLoad& b) {
  constexpr double kSame = 1e-10;
  if (a.elements != b.elements || a.spins != b.spins ||
      std::abs(a.direction.dot(b.direction) - 1.0) > kSame) {
    return false;
  }
  const Vec3 d = a.point - b.point;
  return !a.spins || (d - a.direction.dot(d) * a.direction).norm() <=
                         kSame * std::max(1.0, a.point.norm());
}

}  // namespace

void DeckStepReader::boundary(const DeckCard& card) {
  check_deck_parameters(cards_, card, {"OP", "TYPE"});
  if (const std::string* type = card.find("TYPE");
      type != nullptr && *type != "DISPLACEMENT") {
    cards_.refuse(card, fmt::format("TYPE={} is not known; there is "
                                    "DISPLACEMENT",
                                    shown_field(*type)));
  }
  if (starts_anew(card, 'B')) {
    standing_.held.clear();
  }
  for (const DeckLine& line : card.lines) {
    heed_stop("deck");
    boundary_line(line);
  }
}

void DeckStepReader::boundary_line(const DeckLine& line) {
  const std::vector<std::string_view> fields = deck_fields(line.text);
  if (fields.size() < 2 || fields.size() > 4) {
    cards_.refuse(line.at, fmt::format("'{}' is no support; expected a node or "
                                       "set, its first and last component, "
                                       "and what they are held at if not 0",
                                       shown_field(line.text)));
  }
  std::array<bool, 3> fix{};
  if (const auto named = named_support(deck_word(fields[1]))) {
    fix = *named;
  } else {
    int first = 0;
    int last = 0;
    const bool one = fields.size() < 3 || fields[2].empty();
    if (!read_deck_integer(fields[1], first) ||
        !read_deck_integer(one ? fields[1] : fields[2], last) || first < 1 ||
        last < first || last > kLastRotation) {
      cards_.refuse(line.at,
                    fmt::format("components '{}': solids have the components "
                                "1, 2 and 3 of displacement",
                                shown_field(line.text)));
    }
    for (int k = first; k <= std::min(last, 3); ++k) {
      fix[static_cast<std::size_t>(k) - 1] = true;
    }
  }
  const double displacement =
      fields.size() > 3 && !fields[3].empty()
          ? require_deck_number(cards_, line.at, fields[3], "the displacement")
          : 0.0;
  if (displacement != 0.0 && step_ == 0) {
    cards_.refuse(line.at,
                  "*BOUNDARY enforces a displacement before the first "
                  "*STEP, where CalculiX knows only 0; enforce it in "
                  "a step");
  }
  for (const int number : nodes_named(line.at, fields[0])) {
    for (int k = 0; k < 3; ++k) {
      if (fix[static_cast<std::size_t>(k)]) {
        standing_.held[{number, k}] = displacement;
      }
    }
  }
}

void DeckStepReader::forces(const DeckCard& card) {
  check_deck_parameters(cards_, card, {"OP"});
  if (starts_anew(card, 'C')) {
    standing_.forces.clear();
  }
  for (const DeckLine& line : card.lines) {
    heed_stop("deck");
    const std::vector<std::string_view> fields = deck_fields(line.text);
    if (fields.size() != 3) {
      cards_.refuse(line.at, fmt::format("'{}' is no force; expected a node or "
                                         "set, its component and the force",
                                         shown_field(line.text)));
    }
    const int component = read_deck_component(cards_, line.at, fields[1]);
    const double force =
        require_deck_number(cards_, line.at, fields[2], "the force");
    for (const int number : nodes_named(line.at, fields[0])) {
      standing_.forces[{number, component}].give(force, step_);
    }
  }
}

void DeckStepReader::distributed(const DeckCard& card) {
  check_deck_parameters(cards_, card, {"OP"});
  if (starts_anew(card, 'D')) {
    standing_.pressures.clear();
    standing_.body.clear();
  }
  for (const DeckLine& line : card.lines) {
    heed_stop("deck");
    const std::vector<std::string_view> fields = deck_fields(line.text);
    const std::string label =
        fields.size() > 2 ? deck_word(fields[1]) : std::string();
    const int off = corner_off_deck_face(label, 'P');
    if (label == "GRAV" || label == "CENTRIF") {
      body_load(line, fields);
    } else if (off >= 0) {
      face_load(line, fields, off);
    } else if (label == "P") {
      surface_load(line, fields[0], fields[2]);
    } else {
      cards_.refuse(line.at, fmt::format("'{}' is no load that is known; there "
                                         "are P1 to P4, GRAV and CENTRIF on an "
                                         "element or set",
                                         shown_field(line.text)));
    }
  }
}

void DeckStepReader::press(const DeckPlace& at, int element, int off,
                           double pressure) {
  if (element < 0) {
    cards_.refuse(at, "the deck has no such element");
  }
  standing_.pressures[{element, off}].give(pressure, step_);
}

void DeckStepReader::face_load(const DeckLine& line,
                               const std::vector<std::string_view>& fields,
                               int off) {
  const double pressure =
      require_deck_number(cards_, line.at, fields[2], "the pressure");
  for (const int e : elements_named(cards_, frozen_, line.at, fields[0])) {
    press(line.at, e, off, pressure);
  }
}

void DeckStepReader::body_load(const DeckLine& line,
                               const std::vector<std::string_view>& fields) {
  StandingBodyLoad load;
  load.elements = deck_word(fields[0]);
  load.at = line.at;
  load.spins = deck_word(fields[1]) == "CENTRIF";
  const std::size_t count = load.spins ? 6 : 3;
  if (fields.size() != 3 + count) {
    cards_.refuse(line.at,
                  load.spins ? "CENTRIF wants the square of the rate, a point "
                               "and a direction of the axis"
                             : "GRAV wants the acceleration and its direction");
  }
  if (!load.elements.empty()) {  // refused here, not at the end of the step
    elements_named(cards_, frozen_, line.at, load.elements);
  }
  const double size =
      require_deck_number(cards_, line.at, fields[2], "the load's size");
  std::array<double, 6> v{};
  for (std::size_t k = 0; k < count; ++k) {
    v[k] = require_deck_number(cards_, line.at, fields[3 + k], "a coordinate");
  }
  load.direction = load.spins ? Vec3(v[3], v[4], v[5]) : Vec3(v[0], v[1], v[2]);
  const double length = load.direction.norm();
  if (!(length > 0.0) || !std::isfinite(length)) {
    cards_.refuse(line.at, "the direction has no length");
  }
  load.direction /= length;
  if (load.spins) {
    load.point = Vec3(v[0], v[1], v[2]);
  }
  const auto at = std::find_if(
      standing_.body.begin(), standing_.body.end(),
      [&](const StandingBodyLoad& other) { return alike(other, load); });
  if (at != standing_.body.end()) {
    at->size.give(size, step_);
    return;
  }
  load.size = {size, step_};
  standing_.body.push_back(load);
}

void DeckStepReader::surface_load(const DeckLine& line,
                                  std::string_view surface,
                                  std::string_view value) {
  const double pressure =
      require_deck_number(cards_, line.at, value, "the pressure");
  const auto at = frozen_.model.surfaces.find(deck_word(surface));
  if (at == frozen_.model.surfaces.end()) {
    cards_.refuse(line.at, fmt::format("the deck has no surface '{}'",
                                       shown_field(surface)));
  }
  for (const RawFace& face : at->second) {
    for (const int e :
         elements_named(cards_, frozen_, face.at, face.elements)) {
      press(line.at, e, face.opposite_corner, pressure);
    }
  }
}

void DeckStepReader::surfaces(const DeckCard& card) {
  check_deck_parameters(cards_, card, {"OP"});
  if (starts_anew(card, 'D')) {  // CalculiX counts it as *DLOAD
    standing_.pressures.clear();
    standing_.body.clear();
  }
  for (const DeckLine& line : card.lines) {
    heed_stop("deck");
    const std::vector<std::string_view> fields = deck_fields(line.text);
    if (fields.size() != 3 || deck_word(fields[1]) != "P") {
      cards_.refuse(line.at, fmt::format("'{}' is no load that is known; "
                                         "expected a surface, P and a pressure",
                                         shown_field(line.text)));
    }
    surface_load(line, fields[0], fields[2]);
  }
}

void DeckStepReader::temperatures(const DeckCard& card,
                                  std::map<int, double>& of_node) {
  for (const DeckLine& line : card.lines) {
    heed_stop("deck");
    const std::vector<std::string_view> fields = deck_fields(line.text);
    if (fields.size() != 2) {
      cards_.refuse(line.at, fmt::format("'{}' is no temperature; expected a "
                                         "node or set and its temperature",
                                         shown_field(line.text)));
    }
    const double value =
        require_deck_number(cards_, line.at, fields[1], "the temperature");
    for (const int number : nodes_named(line.at, fields[0])) {
      of_node[number] = value;
    }
  }
}

}  // namespace meniscus::deck
