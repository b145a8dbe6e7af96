#include <algorithm>

#include <fmt/format.h>

#include "io/deck/deck_model.h"

namespace meniscus::deck {

namespace {

constexpr std::size_t kPerMaterialLine = 8;  // constants

}  // namespace

RawMaterial& DeckModelReader::current(const DeckCard& card) {
  if (material_.empty()) {
    deck_.refuse(card, "belongs below the *MATERIAL that it is of");
  }
  return model_.materials.at(material_);
}

std::vector<double> DeckModelReader::numbers(const DeckCard& card,
                                             std::size_t least,
                                             std::size_t most,
                                             const char* expected) const {
  std::vector<double> values;
  bool good = card.lines.size() == 1;
  if (good) {
    for (const std::string_view field : deck_fields(card.lines[0].text)) {
      values.push_back(
          require_deck_number(deck_, card.lines[0].at, field, "a value"));
    }
    good = values.size() >= least && values.size() <= most;
  }
  if (!good) {
    deck_.refuse(card, fmt::format("expected {}", expected));
  }
  return values;
}

void DeckModelReader::material(const DeckCard& card) {
  check_deck_parameters(deck_, card, {"NAME"});
  const std::string* name = card.find("NAME");
  if (name == nullptr || name->empty()) {
    deck_.refuse(card, "give the material a name: NAME=...");
  }
  if (model_.materials.count(*name) > 0) {
    deck_.refuse(card, fmt::format("material '{}' is there already",
                                   shown_field(*name)));
  }
  RawMaterial& material = model_.materials[*name];
  material.material.name = shown_field(*name);
  material.at = card.at;
  model_.material_names.push_back(*name);
  material_ = *name;
}

void DeckModelReader::elastic(const DeckCard& card) {
  check_deck_parameters(deck_, card, {"TYPE"});
  RawMaterial& raw = current(card);
  const std::string* type = card.find("TYPE");
  raw.elastic = true;
  if (type == nullptr || *type == "ISO" || *type == "ISOTROPIC") {
    const std::vector<double> values =
        numbers(card, 2, 3,
                "Young's modulus and Poisson's ratio on one line; what depends "
                "on temperature is not known");
    raw.material.youngs_modulus = values[0];
    raw.material.poisson_ratio = values[1];
    return;
  }
  if (*type != "ENGINEERINGCONSTANTS") {
    deck_.refuse(card, fmt::format("TYPE={} is not known; there are ISO and "
                                   "ENGINEERING CONSTANTS",
                                   shown_field(*type)));
  }
  std::vector<double> values;
  for (const DeckLine& line : card.lines) {
    for (const std::string_view field : deck_fields(line.text)) {
      values.push_back(
          require_deck_number(deck_, line.at, field, "an elastic constant"));
    }
  }
  // The ninth stands on a line of its own, with the temperature behind it.
  constexpr std::size_t kConstants = 9;
  if (card.lines.size() != 2 || values.size() < kConstants ||
      values.size() > kConstants + 1 ||
      deck_fields(card.lines[0].text).size() != kPerMaterialLine) {
    deck_.refuse(card,
                 "expected E1, E2, E3, nu12, nu13, nu23, G12, G13 on one line "
                 "and G23 on the next; what depends on temperature is not "
                 "known");
  }
  io::DeckOrthotropic& m = raw.material.orthotropic.emplace();
  m.youngs_moduli = Vec3(values[0], values[1], values[2]);
  m.poisson_ratios = Vec3(values[3], values[4], values[5]);
  m.shear_moduli = Vec3(values[6], values[7], values[8]);
}

void DeckModelReader::density(const DeckCard& card) {
  check_deck_parameters(deck_, card, {});
  current(card).material.density =
      numbers(card, 1, 2,
              "one density; what depends on temperature is not "
              "known")[0];
}

void DeckModelReader::expansion(const DeckCard& card) {
  // ZERO says where the expansion is counted from, which a constant one does
  // not depend on.
  check_deck_parameters(deck_, card, {"TYPE", "ZERO"});
  const std::string* type = card.find("TYPE");
  const bool ortho = type != nullptr && *type == "ORTHO";
  if (type != nullptr && !ortho && *type != "ISO") {
    deck_.refuse(card, fmt::format("TYPE={} is not known; there are ISO and "
                                   "ORTHO",
                                   shown_field(*type)));
  }
  const std::vector<double> values =
      ortho ? numbers(card, 3, 4,
                      "three expansions on one line; what depends "
                      "on temperature is not known")
            : numbers(card, 1, 2,
                      "one expansion; what depends on temperature "
                      "is not known");
  current(card).material.thermal_expansion =
      ortho ? Vec3(values[0], values[1], values[2]) : Vec3::Constant(values[0]);
}

void DeckModelReader::orientation(const DeckCard& card) {
  check_deck_parameters(deck_, card, {"NAME", "SYSTEM"});
  const std::string* name = card.find("NAME");
  const std::string* system = card.find("SYSTEM");
  if (name == nullptr || name->empty()) {
    deck_.refuse(card, "give the orientation a name: NAME=...");
  }
  if (system != nullptr && *system != "RECTANGULAR") {
    deck_.refuse(card, fmt::format("SYSTEM={} is not known; there is "
                                   "RECTANGULAR",
                                   shown_field(*system)));
  }
  const std::vector<double> v =
      numbers(card, 6, 6,
              "one line of six numbers: a point on axis 1 and one in the plane "
              "of 1 and 2");
  io::DeckOrthotropic& axes = model_.orientations[*name];
  axes.axis_1 = Vec3(v[0], v[1], v[2]);
  axes.axis_2 = Vec3(v[3], v[4], v[5]);
}

}  // namespace meniscus::deck
