#include "pipeline/forward/shell_figures.h"

#include "fea/element/stress_measures.h"

namespace meniscus::forward {

void find_shell_stresses(shells::ShellPart& part) {
  for (std::size_t k = 0; k < part.cases.size(); ++k) {
    part.cases[k].stress = shells::shell_stresses(part, k);
  }
}

StressFigures shell_figures(const EvaluationFields& fields,
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

}  // namespace meniscus::forward
