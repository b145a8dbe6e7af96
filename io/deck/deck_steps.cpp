#include "io/deck/deck_steps.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace meniscus::deck {

namespace {

constexpr const char* kRemark = "load case '";

}  // namespace

DeckStepReader::DeckStepReader(const DeckCards& cards,
                               const FrozenModel& frozen, ReadDeck& deck)
    : cards_(cards), frozen_(frozen), deck_(deck) {}

bool DeckStepReader::read_before(const DeckCard& card) {
  if (card.keyword == "BOUNDARY") {
    boundary(card);
    return true;
  }
  if (card.keyword == "INITIALCONDITIONS") {
    check_deck_parameters(cards_, card, {"TYPE"});
    const std::string* type = card.find("TYPE");
    if (type == nullptr || *type != "TEMPERATURE") {
      cards_.refuse(card, "only TYPE=TEMPERATURE is known");
    }
    temperatures(card, standing_.initial_temperatures);
    return true;
  }
  return false;
}

bool DeckStepReader::read(const DeckCard& card) {
  if (card.keyword == "STEP") {
    begin_step(card);
    return true;
  }
  const bool known = card.keyword == "ENDSTEP" || card.keyword == "STATIC" ||
                     card.keyword == "FREQUENCY" || card.keyword == "BUCKLE" ||
                     card.keyword == "BOUNDARY" || card.keyword == "CLOAD" ||
                     card.keyword == "DLOAD" || card.keyword == "DSLOAD" ||
                     card.keyword == "TEMPERATURE";
  if (!known) {
    return false;
  }
  if (!inside_) {
    cards_.refuse(card, "belongs into a step, between *STEP and *END STEP");
  }
  if (card.keyword == "ENDSTEP") {
    end_step(card);
  } else if (card.keyword == "BOUNDARY") {
    boundary(card);
  } else if (card.keyword == "CLOAD") {
    forces(card);
  } else if (card.keyword == "DLOAD") {
    distributed(card);
  } else if (card.keyword == "DSLOAD") {
    surfaces(card);
  } else if (card.keyword == "TEMPERATURE") {
    check_deck_parameters(cards_, card, {"OP"});
    if (starts_anew(card, 'T')) {
      standing_.temperatures.clear();
    }
    temperatures(card, standing_.temperatures);
  } else {
    procedure(card);
  }
  return true;
}

void DeckStepReader::finish() {
  if (inside_) {
    cards_.refuse(begun_, "the step that begins here has no *END STEP");
  }
  if (deck_.steps.empty()) {
    cards_.refuse(DeckPlace{0, 1},
                  "the deck has no *STEP; say how it is loaded: *STEP, "
                  "*STATIC, *CLOAD, ..., *END STEP");
  }
}

void DeckStepReader::begin_step(const DeckCard& card) {
  if (inside_) {
    cards_.refuse(card, "the step before has no *END STEP");
  }
  check_deck_parameters(
      cards_, card,
      {"NAME", "INC", "INCF", "AMPLITUDE", "PERTURBATION", "NLGEOM", "UNSYMM"});
  if (const std::string* nlgeom = card.find("NLGEOM");
      nlgeom != nullptr && *nlgeom != "NO") {
    cards_.refuse(card,
                  "NLGEOM: large displacements are not known; leave it "
                  "out for the linear answer");
  }
  inside_ = true;
  has_procedure_ = false;
  perturbs_ = card.find("PERTURBATION") != nullptr;
  begun_ = card.at;
  anew_.clear();
  ++step_;
  ReadStep& step = deck_.steps.emplace_back();
  step.place = cards_.place(card.at);
  name_step(card);
}

void DeckStepReader::name_step(const DeckCard& card) {
  ReadStep& step = deck_.steps.back();
  for (const DeckParameter& parameter : card.parameters) {
    if (parameter.name == "NAME") {
      step.name = shown_field(parameter.given);
    }
  }
  const std::size_t from = std::string_view(kRemark).size();
  if (step.name.empty() && card.remark.starts_with(kRemark) &&
      card.remark.size() > from + 1 && card.remark.back() == '\'') {
    step.name =
        shown_field(card.remark.substr(from, card.remark.size() - from - 1));
  }
  const auto taken = [&] {
    return std::count_if(
               deck_.steps.begin(), deck_.steps.end(),
               [&](const ReadStep& s) { return s.name == step.name; }) > 1;
  };
  if (step.name.empty() || taken()) {
    step.name = fmt::format("step_{}", step_);
  }
  while (taken()) {
    step.name += "_";
  }
}

void DeckStepReader::procedure(const DeckCard& card) {
  if (has_procedure_) {
    cards_.refuse(card, "the step has a procedure already");
  }
  has_procedure_ = true;
  ReadStep& step = deck_.steps.back();
  if (card.keyword == "STATIC") {
    check_deck_parameters(
        cards_, card, {"SOLVER", "DIRECT", "TIMERESET", "TOTALTIMEATSTART"});
    if (perturbs_) {
      cards_.refuse(card,
                    "a static step with PERTURBATION; leave it out of "
                    "*STEP");
    }
    preloads_ = true;
    return;
  }
  step.procedure = card.keyword == "BUCKLE" ? DeckProcedure::Buckling
                                            : DeckProcedure::Frequency;
  check_deck_parameters(
      cards_, card,
      {"SOLVER", "STORAGE", "GLOBAL", "EIGENSOLVER", "NORMALIZATION"});
  if (perturbs_ && preloads_) {
    cards_.refuse(card,
                  "PERTURBATION after a static step means its stresses "
                  "as preload, which is not known; leave it out, or put "
                  "the step first");
  }
  const std::vector<std::string_view> fields =
      card.lines.empty() ? std::vector<std::string_view>{""}
                         : deck_fields(card.lines.front().text);
  constexpr int kMostModes = 1000;
  if (!read_deck_integer(fields.front(), step.modes) || step.modes < 1 ||
      step.modes > kMostModes) {
    cards_.refuse(card, fmt::format("expected the number of modes, 1 to {}, in "
                                    "the line below",
                                    kMostModes));
  }
  const bool bounded = std::any_of(fields.begin() + 1, fields.end(),
                                   [](auto field) { return !field.empty(); });
  if (bounded && step.procedure == DeckProcedure::Frequency) {
    cards_.refuse(card,
                  "bounds of frequencies are not known; give the number "
                  "of modes alone");
  }
  // CalculiX removes the loads of earlier steps from such a step on.
  const auto is_older = [&](const auto& entry) {
    return entry.second.step < step_;
  };
  std::erase_if(standing_.forces, is_older);
  std::erase_if(standing_.pressures, is_older);
  std::erase_if(standing_.body, [&](const StandingBodyLoad& load) {
    return load.size.step < step_;
  });
  if (anew_.find('T') == std::string::npos) {
    standing_.temperatures.clear();
  }
}

bool DeckStepReader::starts_anew(const DeckCard& card, char kind) {
  const bool first = anew_.find(kind) == std::string::npos;
  anew_ += kind;
  const std::string* op = card.find("OP");
  if (op != nullptr && *op != "NEW" && *op != "MOD") {
    cards_.refuse(
        card, fmt::format("OP={}; there are MOD and NEW", shown_field(*op)));
  }
  return first && op != nullptr && *op == "NEW";
}

std::vector<int> DeckStepReader::nodes_named(const DeckPlace& at,
                                             std::string_view field) {
  std::vector<int> numbers;
  for (const int place : frozen_.model.node_sets.places_named(
           cards_, at, field, frozen_.model.node_numbers)) {
    numbers.push_back(frozen_.model.node_numbers.number(place));
  }
  return numbers;
}

int DeckStepReader::mesh_node(int number) const {
  const int place = frozen_.model.node_numbers.place_of(number);
  return place < 0 ? -1 : frozen_.node_of[static_cast<std::size_t>(place)];
}

void DeckStepReader::end_step(const DeckCard& card) {
  if (!has_procedure_) {
    cards_.refuse(begun_,
                  "the step has no procedure; there are *STATIC, "
                  "*FREQUENCY and *BUCKLE");
  }
  inside_ = false;
  ReadStep& step = deck_.steps.back();
  put_holds(card, step);
  put_deck_springs(cards_, frozen_, standing_.held, step);
  if (step.procedure != DeckProcedure::Frequency) {
    put_forces(card, step);
    put_pressures(step);
    put_body_loads(step);
    put_temperatures(step);
  }
}

void DeckStepReader::put_holds(const DeckCard& card, ReadStep& step) {
  for (const auto& [where, displacement] : standing_.held) {
    const int node = mesh_node(where.first);
    if (node >= 0) {
      step.holds.push_back({node, Vec3::Unit(where.second), displacement});
    }
    if (displacement != 0.0 && step.procedure != DeckProcedure::Static) {
      cards_.refuse(card, fmt::format("node {} is held at a displacement that "
                                      "is not 0; only *STATIC steps know that",
                                      where.first));
    }
  }
  std::stable_sort(
      step.holds.begin(), step.holds.end(),
      [](const ReadHold& a, const ReadHold& b) { return a.node < b.node; });
}

void DeckStepReader::put_forces(const DeckCard& card, ReadStep& step) {
  for (const auto& [where, force] : standing_.forces) {
    if (force.value == 0.0) {
      continue;
    }
    const int node = mesh_node(where.first);
    if (node < 0) {
      cards_.refuse(card, fmt::format("a force acts on node {}, which is in no "
                                      "element",
                                      where.first));
    }
    if (step.nodal_forces.size() == 0) {
      step.nodal_forces =
          VectorX::Zero(static_cast<Eigen::Index>(3 * deck_.mesh.nodes.size()));
    }
    step.nodal_forces[3L * node + where.second] = force.value;
  }
}

void DeckStepReader::put_pressures(ReadStep& step) {
  for (const auto& [where, pressure] : standing_.pressures) {
    if (pressure.value != 0.0) {
      step.pressures.push_back({where[0], where[1], pressure.value});
    }
  }
}

void DeckStepReader::put_body_loads(ReadStep& step) {
  for (const StandingBodyLoad& load : standing_.body) {
    if (load.size.value == 0.0) {
      continue;
    }
    ReadBodyLoad& body = step.body_loads.emplace_back();
    if (load.elements.empty()) {
      body.elements = frozen_.element_of;
    } else {
      body.elements = elements_named(cards_, frozen_, load.at, load.elements);
    }
    if (load.spins) {
      if (load.size.value < 0.0) {
        cards_.refuse(load.at,
                      "CENTRIF wants the square of the rate, which is "
                      "not below 0");
      }
      body.spin =
          io::DeckSpin{load.point, load.direction, std::sqrt(load.size.value)};
    } else {
      body.gravity = load.size.value * load.direction;
    }
  }
}

void DeckStepReader::put_temperatures(ReadStep& step) {
  if (standing_.temperatures.empty()) {
    return;
  }
  VectorX change =
      VectorX::Zero(static_cast<Eigen::Index>(deck_.mesh.nodes.size()));
  for (const auto& [number, temperature] : standing_.temperatures) {
    const int node = mesh_node(number);
    const auto initial = standing_.initial_temperatures.find(number);
    if (initial == standing_.initial_temperatures.end()) {
      cards_.refuse(begun_, fmt::format("node {} has a temperature in this "
                                        "step, but none in *INITIAL "
                                        "CONDITIONS, TYPE=TEMPERATURE",
                                        number));
    }
    if (node >= 0) {
      change[node] = temperature - initial->second;
    }
  }
  if (!change.isZero(0.0)) {
    step.temperature_change = std::move(change);
  }
}

}  // namespace meniscus::deck
