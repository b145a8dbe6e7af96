/// What holds a shell part in a load case, and what its numbers do.
#pragma once

#include <vector>

#include "fea/loads/load_case.h"
#include "fea/shell/rigid_rims.h"
#include "fea/shell/shell_supports.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::shells {

/// What holds the nodes of the part. Throws InvalidInput for a rim of no edge.
std::vector<shell::NodeSupport> node_supports(const ShellPart& part,
                                              const loads::LoadCase& load_case);

/// One per pin of the load case, of rims and films. Throws as node_supports().
std::vector<shell::RigidRim> rigid_rims(const ShellPart& part,
                                        const loads::LoadCase& load_case);

/// Without those of nodes on rims, which hold their nodes by themselves.
std::vector<shell::NodeSupport> off_rims(
    std::vector<shell::NodeSupport> supports,
    const shell::ShellFreedom& freedom);

/// The springs under its films.
std::vector<shell::GroundSpring> ground_springs(
    const ShellPart& part, const loads::LoadCase& load_case);

/// What a functional J changes by as the numbers do at `rates` that supports
/// and rigid rims are held at, and the rims' points. `by`: the load case's
/// solution and its adjoint.
double held_rate(const ShellPart& part, const loads::LoadCase& load_case,
                 const loads::LoadCase& rates, const shell::RimPair& by);

}  // namespace meniscus::shells
