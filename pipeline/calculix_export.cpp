#include "pipeline/calculix_export.h"

#include "fea/loads.h"

namespace meniscus {

namespace {

DeckStep step_of(const LoadCase& load_case, const TetMesh& mesh) {
  DeckStep step{.name = load_case.name};
  for (const Support& s : load_case.supports) {
    step.supports.push_back({.surface = s.surface,
                             .fix_x = s.fix_x,
                             .fix_y = s.fix_y,
                             .fix_z = s.fix_z});
  }
  LoadCase forces = load_case;
  forces.pressures.clear();
  if (!forces.forces.empty()) {
    step.nodal_forces = nodal_forces(mesh, forces);
  }
  for (const SurfacePressure& p : load_case.pressures) {
    step.pressures.push_back({p.surface, p.pressure});
  }
  return step;
}

}  // namespace

CalculixDeck calculix_deck_of(const Case& input, const EvaluatedCase& numbers,
                              const TetMesh& mesh) {
  CalculixDeck deck;
  deck.comments = {"case: " + input.title, "units: " + input.units.name};
  for (const Material& m : numbers.materials) {
    deck.materials.push_back({.name = m.name,
                              .youngs_modulus = m.youngs_modulus,
                              .poisson_ratio = m.poisson_ratio,
                              .density = m.density});
  }
  for (const LoadCase& load_case : numbers.load_cases) {
    deck.steps.push_back(step_of(load_case, mesh));
  }
  return deck;
}

}  // namespace meniscus
