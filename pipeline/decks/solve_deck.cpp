#include "pipeline/decks/solve_deck.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/heed_stop.h"
#include "core/timer.h"
#include "fea/functionals/volume_functionals.h"
#include "fea/loads/loads.h"
#include "pipeline/decks/compared_deck.h"

namespace meniscus::decks {

namespace {

// Factors that strain the part by more than its own size are none.
constexpr double kLeastSearch = 1e4;

Vec3 sum_of(const VectorX& forces) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index k = 0; k < forces.size(); k += 3) {
    sum += forces.segment<3>(k);
  }
  return sum;
}

void find_largest(const DeckResult& result, const VectorX& u,
                  DeckStepFigures& step) {
  std::size_t node = 0;
  double square = -1.0;
  for (Eigen::Index k = 0; k < u.size(); k += 3) {
    if (u.segment<3>(k).squaredNorm() > square) {
      square = u.segment<3>(k).squaredNorm();
      node = static_cast<std::size_t>(k / 3);
    }
  }
  step.largest_displacement = std::sqrt(square);
  step.largest_node = result.node_numbers[node];
  step.largest_position = result.fields.mesh.nodes[node];
}

double stiffest(const std::vector<element::Material>& materials) {
  double largest = 0.0;
  for (const element::Material& m : materials) {
    largest = std::max(largest, m.orthotropic
                                    ? m.orthotropic->youngs_moduli.maxCoeff()
                                    : m.youngs_modulus);
  }
  return largest;
}

class DeckSolver {
 public:
  DeckSolver(DeckPart part, Monitor* monitor)
      : part_(std::move(part)), monitor_(monitor) {}

  DeckResult solve() {
    const Timer timer;
    const Heeding heeding(monitor_);
    begin();
    if (!fields().inputs.load_cases.empty()) {
      solve_statics();
    }
    for (std::size_t s = 0; s < result_.steps.size(); ++s) {
      if (result_.steps[s].procedure == deck::DeckProcedure::Frequency) {
        find_frequencies(s);
      }
    }
    result_.seconds = timer.seconds();
    return std::move(result_);
  }

 private:
  forward::EvaluationFields& fields() { return result_.fields; }

  void begin() {
    deck::ReadDeck& deck = part_.deck;
    result_.title = deck.heading;
    result_.node_numbers = std::move(deck.node_numbers);
    result_.element_numbers = std::move(deck.element_numbers);
    result_.not_needed = std::move(deck.not_needed);
    fields().mesh = std::move(deck.mesh);
    fields().inputs.materials = part_.materials;
    for (std::size_t s = 0; s < deck.steps.size(); ++s) {
      DeckStepFigures& step = result_.steps.emplace_back();
      step.name = deck.steps[s].name;
      step.procedure = deck.steps[s].procedure;
      if (step.procedure != deck::DeckProcedure::Frequency) {
        step.load_case = fields().inputs.load_cases.size();
        fields().inputs.load_cases.push_back(part_.load_cases[s]);
      }
    }
    result_.volume = functionals::volume_functional(fields().mesh,
                                                    element::Derivatives::None)
                         .value;
    if (std::all_of(part_.materials.begin(), part_.materials.end(),
                    [](const auto& m) { return m.density > 0.0; })) {
      result_.mass =
          functionals::mass_functional(fields().mesh, part_.materials,
                                       element::Derivatives::None)
              .value;
    }
  }

  void solve_statics() {
    const elastic::ElasticModel model(fields().mesh, part_.materials,
                                      fields().inputs.load_cases,
                                      {.monitor = monitor_});
    fields().solution = model.base_solution();
    if (fields().solution.failure) {
      throw SolverError(fields().solution.failure->message);
    }
    fields().stresses = forward::part_stresses(fields().mesh, fields().inputs,
                                               fields().solution);
    result_.stress = forward::stress_figures(fields());
    for (std::size_t s = 0; s < result_.steps.size(); ++s) {
      DeckStepFigures& step = result_.steps[s];
      if (!step.load_case) {
        continue;
      }
      const std::size_t c = *step.load_case;
      find_largest(result_, fields().solution.displacements[c], step);
      step.load = sum_of(loads::nodal_forces(
          fields().mesh, fields().inputs.load_cases[c], part_.materials));
      step.reaction = sum_of(fields().solution.reactions[c]);
      if (step.procedure == deck::DeckProcedure::Buckling) {
        find_buckling(model, s);
      }
    }
  }

  void find_buckling(const elastic::ElasticModel& model, std::size_t s) {
    DeckStepFigures& step = result_.steps[s];
    const std::size_t c = *step.load_case;
    const double strain =
        result_.stress[c].max_von_mises / stiffest(part_.materials);
    modes::BucklingOptions options{.count = part_.deck.steps[s].modes,
                                   .monitor = monitor_};
    options.largest =
        strain > 0.0 ? std::max(kLeastSearch, 1.0 / strain) : kLeastSearch;
    step.buckling = modes::buckling_modes(
        model, fields().mesh, fields().inputs.load_cases, static_cast<int>(c),
        fields().solution.displacements[c], options);
    for (std::size_t k = 0; k < step.buckling->shapes.size(); ++k) {
      fields().modes.push_back(
          {fmt::format("{}_{}", step.name, k + 1),
           fmt::format("factor {:.8g}", step.buckling->factors[k]),
           step.buckling->shapes[k]});
    }
  }

  /// With CalculiX's mass, so that a deck means the same to both.
  void find_frequencies(std::size_t s) {
    DeckStepFigures& step = result_.steps[s];
    step.frequencies = modes::natural_modes(
        fields().mesh, part_.materials, part_.load_cases[s],
        {.count = part_.deck.steps[s].modes,
         .mass = solver::MassRule::StiffnessPoints,
         .monitor = monitor_});
    for (std::size_t k = 0; k < step.frequencies->shapes.size(); ++k) {
      fields().modes.push_back(
          {fmt::format("{}_{}", step.name, k + 1),
           fmt::format("{:.8g} 1/time", step.frequencies->frequencies[k]),
           step.frequencies->shapes[k]});
    }
  }

  DeckPart part_;
  Monitor* monitor_;
  DeckResult result_;
};

}  // namespace

DeckResult solve_deck(DeckPart part, Monitor* monitor) {
  return DeckSolver(std::move(part), monitor).solve();
}

case_data::Case deck_case(const DeckResult& result,
                          const std::optional<UnitSystem>& units) {
  case_data::Case input;
  input.title = result.title;
  if (units) {
    input.units = *units;
  }
  return case_for_fields(std::move(input), result.fields);
}

}  // namespace meniscus::decks
