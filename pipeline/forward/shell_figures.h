/// Figures of a solved shell's stresses.
#pragma once

#include "pipeline/forward/stress_figures.h"

namespace meniscus::forward {

/// Fills in each load case's.
void find_shell_stresses(shells::ShellPart& part);

/// The peak at nodes of both faces and the middle; with the safety of the
/// material there.
StressFigures shell_figures(const EvaluationFields& fields,
                            std::size_t load_case);

}  // namespace meniscus::forward
