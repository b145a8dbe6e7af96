#include "pipeline/shells/shell_eigen.h"

#include "fea/shell_modes/shell_modes.h"
#include "pipeline/case_data/case_entries.h"

namespace meniscus::shells {

modes::NaturalModes natural_modes(const ShellPart& part, int held,
                                  const modes::ModeOptions& options) {
  if (held == case_data::AnalysisEntry::kFree) {
    return shell::natural_modes(part.mesh, part.sections, {}, options);
  }
  return shell::natural_modes(
      *part.cases[static_cast<std::size_t>(held)].system, part.sections,
      options);
}

modes::BucklingModes buckling_modes(const ShellPart& part,
                                    std::size_t load_case,
                                    const std::string& name,
                                    const modes::BucklingOptions& options) {
  const ShellCase& own = part.cases[load_case];
  return shell::buckling_modes(*own.system, own.actions.loads, own.displacement,
                               name, options);
}

}  // namespace meniscus::shells
