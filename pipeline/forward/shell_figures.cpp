#include "pipeline/forward/shell_figures.h"

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

StressFigures peak_figures(const std::string& load_case,
                           const stress::Peak& peak,
                           const element::Material& material) {
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
  const std::string& name = fields.inputs.load_cases[load_case].name;
  const shells::ShellPeak peak =
      shells::shell_peak(part, part.cases[load_case].stress);
  // Of the weakest material at its peak: sections may differ.
  StressFigures figures = peak_figures(
      name, {.von_mises = peak.von_mises, .position = peak.position},
      part.sections[part.mesh.section[peak.facet]].laminate.plies[0].material);
  if (!part.solid) {
    return figures;
  }
  const stress::Peak of_solid =
      stress::peak_of(part.solid->mesh, part.cases[load_case].solid_stress, {});
  StressFigures solid =
      peak_figures(name, of_solid, part.solid->materials[of_solid.region]);
  const bool is_weaker =
      solid.safety &&
      (!figures.safety || solid.safety->factor < figures.safety->factor);
  if (is_weaker) {
    figures.safety = solid.safety;
  }
  if (of_solid.von_mises > figures.max_von_mises) {
    solid.safety = figures.safety;
    return solid;
  }
  return figures;
}

}  // namespace meniscus::forward
