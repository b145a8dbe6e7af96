#include "pipeline/forward/shell_figures.h"

namespace meniscus::forward {

void find_shell_stresses(shells::ShellPart& part) {
  for (std::size_t k = 0; k < part.cases.size(); ++k) {
    part.cases[k].stress = shells::shell_stresses(part, k);
  }
}

StressFigures shell_figures(const EvaluationFields& fields,
                            std::size_t load_case) {
  const shells::ShellPart& part = *fields.shell;
  const shells::ShellPeak peak =
      shells::shell_peak(part, part.cases[load_case].stress);
  StressFigures figures{.load_case = fields.inputs.load_cases[load_case].name,
                        .max_von_mises = peak.von_mises,
                        .position = peak.position};
  const stress::Peak same{.von_mises = peak.von_mises,
                          .position = peak.position};
  figures.readings = {.recovered = same, .averaged = same, .points = same};
  // Of the weakest material at its peak: sections may differ.
  const element::Material& material =
      fields.inputs.materials[part.mesh.section[peak.facet]];
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

}  // namespace meniscus::forward
