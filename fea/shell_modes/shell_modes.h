/// Natural frequencies and buckling factors of shells: what fea/modes finds of
/// solids, by the shell's own factor.
#pragma once

#include <string>
#include <vector>

#include "fea/modes/buckling.h"
#include "fea/modes/modes.h"
#include "fea/shell/shell_system.h"

namespace meniscus::shell {

// Of the options, materials and what may be factored are of solids. Shapes have
// 6 numbers per node, and largest components of displacements; those to begin
// with, too.

/// Held as the system is. Throws InvalidInput for a material without density.
modes::NaturalModes natural_modes(const ShellSystem& system,
                                  const std::vector<Section>& sections,
                                  const modes::ModeOptions& options = {});

/// Supports may leave rigid motions: the stiffness is then shifted by a
/// multiple of the mass, and they are counted. Throws as ShellSystem does but
/// for these, and as above.
modes::NaturalModes natural_modes(const ShellMesh& mesh,
                                  const std::vector<Section>& sections,
                                  const std::vector<NodeSupport>& supports,
                                  const modes::ModeOptions& options = {});

/// `displacement`: the system's solution under `loads`; `load_case`: its name,
/// for messages.
modes::BucklingModes buckling_modes(const ShellSystem& system,
                                    const ShellLoads& loads,
                                    const VectorX& displacement,
                                    const std::string& load_case,
                                    const modes::BucklingOptions& options = {});

}  // namespace meniscus::shell
