#include "io/deck/deck_model.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/nearest_name.h"

namespace meniscus::deck {

namespace {

/// Elements that meshers leave of lines and surfaces; solids do not feel them
/// unless they have a section of their own, which is refused.
bool is_of_surface_mesh(const std::string& type) {
  static const std::vector<std::string> kTypes = {
      "CPS3", "CPS6", "T3D2", "T3D3", "S3", "S6", "STRI65"};
  return std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end();
}

}  // namespace

void check_deck_parameters(const DeckCards& deck, const DeckCard& card,
                           const std::vector<std::string>& known) {
  for (const DeckParameter& parameter : card.parameters) {
    if (std::find(known.begin(), known.end(), parameter.name) == known.end()) {
      deck.refuse(
          card,
          fmt::format("the parameter {} is not known{}; leave it out",
                      shown_field(parameter.name),
                      known.empty() ? std::string()
                                    : fmt::format(" (there are {})",
                                                  fmt::join(known, ", "))));
    }
  }
}

int read_deck_component(const DeckCards& deck, const DeckPlace& at,
                        std::string_view field) {
  int component = 0;
  if (!read_deck_integer(field, component) || component < 1 || component > 3) {
    deck.refuse(at, fmt::format("component '{}': solids have the components 1, "
                                "2 and 3 of displacement",
                                shown_field(field)));
  }
  return component - 1;
}

double require_deck_number(const DeckCards& deck, const DeckPlace& at,
                           std::string_view field, const char* what) {
  double value = 0.0;
  if (!read_deck_number(field, value)) {
    deck.refuse(at, fmt::format("{} is '{}', which is no finite number", what,
                                shown_field(field)));
  }
  return value;
}

int corner_off_deck_face(std::string_view label, char letter) {
  constexpr std::array<int, 4> kOff = {3, 2, 0, 1};  // of faces 1 to 4
  if (label.size() != 2 || label[0] != letter || label[1] < '1' ||
      label[1] > '4') {
    return -1;
  }
  return kOff[static_cast<std::size_t>(label[1] - '1')];
}

bool DeckModelReader::read(const DeckCard& card) {
  using Read = void (DeckModelReader::*)(const DeckCard&);
  static const std::map<std::string, Read> kCards = {
      {"NODE", &DeckModelReader::nodes},
      {"ELEMENT", &DeckModelReader::elements},
      {"SURFACE", &DeckModelReader::surface},
      {"MATERIAL", &DeckModelReader::material},
      {"ELASTIC", &DeckModelReader::elastic},
      {"DENSITY", &DeckModelReader::density},
      {"EXPANSION", &DeckModelReader::expansion},
      {"ORIENTATION", &DeckModelReader::orientation},
      {"SOLIDSECTION", &DeckModelReader::section},
      {"SPRING", &DeckModelReader::spring},
      {"EQUATION", &DeckModelReader::equations}};
  if (card.keyword == "HEADING") {
    if (!card.lines.empty() && model_.heading.empty()) {
      model_.heading = shown_field(card.lines.front().text);
    }
    return true;
  }
  if (card.keyword == "NSET") {
    check_deck_parameters(deck_, card, {"NSET", "GENERATE", "UNSORTED"});
    model_.node_sets.add_card(deck_, card);
    return true;
  }
  if (card.keyword == "ELSET") {
    check_deck_parameters(deck_, card, {"ELSET", "GENERATE", "UNSORTED"});
    model_.element_sets.add_card(deck_, card);
    return true;
  }
  const auto at = kCards.find(card.keyword);
  if (at == kCards.end()) {
    return false;
  }
  (this->*at->second)(card);
  return true;
}

void DeckModelReader::nodes(const DeckCard& card) {
  check_deck_parameters(deck_, card, {"NSET"});
  const std::string* set = card.find("NSET");
  for (const DeckLine& line : card.lines) {
    const std::vector<std::string_view> fields = deck_fields(line.text);
    int number = 0;
    Vec3 x = Vec3::Zero();
    bool good = !fields.empty() && fields.size() <= 4 &&
                read_deck_integer(fields[0], number) && number > 0;
    for (std::size_t k = 1; good && k < fields.size(); ++k) {
      good = read_deck_number(fields[k], x[static_cast<int>(k) - 1]);
    }
    if (!good) {
      deck_.refuse(line.at, fmt::format("'{}' is no node; expected its number "
                                        "and three finite coordinates",
                                        shown_field(line.text)));
    }
    model_.node_numbers.add(number);
    model_.nodes.push_back(x);
    model_.node_places.push_back(line.at);
    if (set != nullptr) {
      model_.node_sets.add(*set, {number, number, 1});
    }
  }
}

void DeckModelReader::elements(const DeckCard& card) {
  check_deck_parameters(deck_, card, {"TYPE", "ELSET"});
  const std::string* type = card.find("TYPE");
  if (type != nullptr && *type == "SPRING1") {
    return spring_elements(card);
  }
  if (type != nullptr && is_of_surface_mesh(*type)) {
    model_.not_needed.push_back(fmt::format("{}, TYPE={} ({})", card.written,
                                            *type, deck_.place(card.at)));
    return;
  }
  const int count = type == nullptr    ? 0
                    : *type == "C3D4"  ? 4
                    : *type == "C3D10" ? 10
                                       : 0;
  if (count == 0) {
    deck_.refuse(
        card, fmt::format("elements of type '{}' are not known; mesh the part "
                          "with C3D4 or C3D10 (tetrahedra), and leave out "
                          "elements of lines and surfaces",
                          type == nullptr ? "" : shown_field(*type)));
  }
  if (model_.nodes_per_element != 0 && model_.nodes_per_element != count) {
    deck_.refuse(card, "C3D4 and C3D10 in one deck; use one of them for all");
  }
  model_.nodes_per_element = count;
  const std::string* set = card.find("ELSET");
  std::vector<int> ids;
  DeckPlace begun;
  for (const DeckLine& line : card.lines) {
    begun = ids.empty() ? line.at : begun;
    for (const std::string_view field : deck_fields(line.text)) {
      int id = 0;
      if (!read_deck_integer(field, id) || id <= 0 ||
          static_cast<int>(ids.size()) > count) {
        deck_.refuse(line.at,
                     fmt::format("'{}' is no element; expected its number and "
                                 "those of its {} nodes",
                                 shown_field(line.text), count));
      }
      ids.push_back(id);
    }
    if (static_cast<int>(ids.size()) == count + 1) {
      RawElement& element = model_.elements.emplace_back();
      element.at = begun;
      std::copy(ids.begin() + 1, ids.end(), element.nodes.begin());
      model_.element_numbers.add(ids.front());
      if (set != nullptr) {
        model_.element_sets.add(*set, {ids.front(), ids.front(), 1});
      }
      ids.clear();
    }
  }
  if (!ids.empty()) {
    deck_.refuse(begun, fmt::format("element {} has {} nodes; {} has {}",
                                    ids.front(), ids.size() - 1, *type, count));
  }
}

void DeckModelReader::spring_elements(const DeckCard& card) {
  const std::string* set = card.find("ELSET");
  if (set == nullptr) {
    deck_.refuse(card, "springs need a set for their *SPRING: ELSET=NAME");
  }
  for (const DeckLine& line : card.lines) {
    const std::vector<std::string_view> fields = deck_fields(line.text);
    RawSpring spring{.at = line.at};
    if (fields.size() != 2 || !read_deck_integer(fields[0], spring.element) ||
        !read_deck_integer(fields[1], spring.node) || spring.element <= 0) {
      deck_.refuse(line.at, fmt::format("'{}' is no spring to the ground; "
                                        "expected its number and its node's",
                                        shown_field(line.text)));
    }
    model_.spring_sets[*set].push_back(static_cast<int>(model_.springs.size()));
    model_.springs.push_back(spring);
  }
}

void DeckModelReader::surface(const DeckCard& card) {
  check_deck_parameters(deck_, card, {"NAME", "TYPE"});
  const std::string* name = card.find("NAME");
  const std::string* type = card.find("TYPE");
  if (name == nullptr || name->empty()) {
    deck_.refuse(card, "give the surface a name: NAME=...");
  }
  if (type != nullptr && *type != "ELEMENT") {
    deck_.refuse(card, fmt::format("surfaces of TYPE={} are not known; use "
                                   "TYPE=ELEMENT with faces S1 to S4",
                                   shown_field(*type)));
  }
  const auto [at, is_new] = model_.surfaces.try_emplace(*name);
  if (is_new) {
    model_.surface_names.push_back(*name);
  }
  for (const DeckLine& line : card.lines) {
    const std::vector<std::string_view> fields = deck_fields(line.text);
    const std::string label =
        fields.size() == 2 ? deck_word(fields[1]) : std::string();
    const int off = corner_off_deck_face(label, 'S');
    if (off < 0) {
      deck_.refuse(line.at, fmt::format("'{}' is no face; expected an element "
                                        "or set and S1, S2, S3 or S4",
                                        shown_field(line.text)));
    }
    at->second.push_back({deck_word(fields[0]), off, line.at});
  }
}

void DeckModelReader::section(const DeckCard& card) {
  check_deck_parameters(deck_, card, {"ELSET", "MATERIAL", "ORIENTATION"});
  const auto required = [&](const char* parameter) {
    const std::string* value = card.find(parameter);
    if (value == nullptr || value->empty()) {
      deck_.refuse(card, fmt::format("{}=NAME is missing", parameter));
    }
    return *value;
  };
  const std::string* orientation = card.find("ORIENTATION");
  model_.sections.push_back(
      {required("ELSET"), required("MATERIAL"),
       orientation == nullptr ? std::string() : *orientation, card.at});
}

void DeckModelReader::spring(const DeckCard& card) {
  check_deck_parameters(deck_, card, {"ELSET"});
  const std::string* set = card.find("ELSET");
  if (set == nullptr || card.lines.size() != 2) {
    deck_.refuse(card,
                 "expected ELSET=NAME, a line with the component that the "
                 "springs act along and one with their stiffness");
  }
  RawSpringSection section{.elset = *set, .at = card.at};
  section.component = read_deck_component(
      deck_, card.lines[0].at, deck_fields(card.lines[0].text).front());
  section.stiffness = require_deck_number(
      deck_, card.lines[1].at, deck_fields(card.lines[1].text).front(),
      "the springs' stiffness");
  if (!(section.stiffness > 0.0)) {
    deck_.refuse(card.lines[1].at, "the springs' stiffness must be above 0");
  }
  model_.spring_sections.push_back(std::move(section));
}

void DeckModelReader::equations(const DeckCard& card) {
  check_deck_parameters(deck_, card, {});
  for (std::size_t k = 0; k < card.lines.size();) {
    RawEquation equation{.terms = {}, .at = card.lines[k].at};
    int count = 0;
    if (!read_deck_integer(deck_fields(card.lines[k].text).front(), count) ||
        count < 1) {
      deck_.refuse(equation.at, "expected the number of the equation's terms");
    }
    for (++k; k < card.lines.size() &&
              static_cast<int>(equation.terms.size()) < count;
         ++k) {
      const std::vector<std::string_view> fields =
          deck_fields(card.lines[k].text);
      for (std::size_t f = 0; f + 2 < fields.size(); f += 3) {
        RawEquation::Term& term = equation.terms.emplace_back();
        if (!read_deck_integer(fields[f], term.node)) {
          deck_.refuse(card.lines[k].at, fmt::format("'{}' is no node number",
                                                     shown_field(fields[f])));
        }
        term.component =
            read_deck_component(deck_, card.lines[k].at, fields[f + 1]);
        term.coefficient = require_deck_number(
            deck_, card.lines[k].at, fields[f + 2], "the term's coefficient");
      }
      if (fields.size() % 3 != 0) {
        deck_.refuse(card.lines[k].at,
                     "a term is a node, a component and a coefficient");
      }
    }
    if (static_cast<int>(equation.terms.size()) != count) {
      deck_.refuse(equation.at, fmt::format("the equation has {} terms, not {}",
                                            equation.terms.size(), count));
    }
    model_.equations.push_back(std::move(equation));
  }
}

}  // namespace meniscus::deck
