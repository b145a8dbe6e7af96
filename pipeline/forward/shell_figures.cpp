#include "pipeline/forward/shell_figures.h"

#include "fea/element/stress_measures.h"
#include "fea/stress/peak_stress.h"
#include "pipeline/shells/joint_part.h"

namespace meniscus::forward {

void find_shell_stresses(shells::ShellPart& part) {
  for (std::size_t k = 0; k < part.cases.size(); ++k) {
    part.cases[k].stress = shells::shell_stresses(part, k);
    if (part.solid) {
      part.cases[k].solid_stress = shells::solid_stress(part, k);
    }
  }
}

namespace {

/// Of the layer that is nearest to its strength: sections may differ.
StressFigures figures_of_shell(const EvaluationFields& fields,
                               std::size_t load_case) {
  const shells::ShellPart& part = *fields.shell;
  StressFigures figures{.load_case = fields.inputs.load_cases[load_case].name};
  double largest_ratio = 0.0;
  shells::visit_nodal_stresses(
      part, load_case,
      [&](int facet, int node, int layer, const element::Stress& stress) {
        const double von_mises = element::von_mises(stress);
        const Vec3& at = part.mesh.nodes[part.mesh.facets[facet][node]];
        if (von_mises > figures.max_von_mises) {
          figures.max_von_mises = von_mises;
          figures.position = at;
        }
        const element::Material& material = fields.inputs.materials[layer];
        const double ratio = material.yield_strength
                                 ? von_mises / *material.yield_strength
                                 : 0.0;
        if (ratio > largest_ratio) {
          largest_ratio = ratio;
          figures.safety =
              StressFigures::Safety{.factor = 1.0 / ratio,
                                    .von_mises = von_mises,
                                    .position = at,
                                    .material = material.name,
                                    .yield_strength = *material.yield_strength};
        }
      });
  const stress::Peak same{.von_mises = figures.max_von_mises,
                          .position = figures.position};
  figures.readings = {.recovered = same, .averaged = same, .points = same};
  return figures;
}

StressFigures figures_of_solid(const shells::SolidPart& solid,
                               const std::string& load_case,
                               const stress::RecoveredStress& stress) {
  const stress::Peak peak = stress::peak_of(solid.mesh, stress, {});
  const element::Material& material = solid.materials[peak.region];
  StressFigures figures{.load_case = load_case,
                        .max_von_mises = peak.von_mises,
                        .position = peak.position};
  figures.readings = {.recovered = peak, .averaged = peak, .points = peak};
  if (material.yield_strength && peak.von_mises > 0.0) {
    figures.safety = StressFigures::Safety{
        .factor = *material.yield_strength / peak.von_mises,
        .von_mises = peak.von_mises,
        .position = peak.position,
        .material = material.name,
        .yield_strength = *material.yield_strength};
  }
  return figures;
}

}  // namespace

StressFigures shell_figures(const EvaluationFields& fields,
                            std::size_t load_case) {
  const shells::ShellPart& part = *fields.shell;
  StressFigures figures = figures_of_shell(fields, load_case);
  if (!part.solid) {
    return figures;
  }
  StressFigures solid = figures_of_solid(*part.solid, figures.load_case,
                                         part.cases[load_case].solid_stress);
  if (solid.safety &&
      (!figures.safety || solid.safety->factor < figures.safety->factor)) {
    figures.safety = solid.safety;
  }
  if (solid.max_von_mises > figures.max_von_mises) {
    solid.safety = figures.safety;
    return solid;
  }
  return figures;
}

}  // namespace meniscus::forward
