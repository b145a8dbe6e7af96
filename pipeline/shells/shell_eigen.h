/// Modes of a solved shell: 6 numbers per node, options as fea/shell has them.
#pragma once

#include <string>

#include "fea/modes/buckling.h"
#include "fea/modes/modes.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::shells {

/// Held as in that load case, or by nothing: AnalysisEntry::kFree. Throws
/// InvalidInput and SolverError as shell::natural_modes().
modes::NaturalModes natural_modes(const ShellPart& part, int held,
                                  const modes::ModeOptions& options);

/// Of the loads of a solved load case; `name`: its, for messages.
modes::BucklingModes buckling_modes(const ShellPart& part,
                                    std::size_t load_case,
                                    const std::string& name,
                                    const modes::BucklingOptions& options);

}  // namespace meniscus::shells
