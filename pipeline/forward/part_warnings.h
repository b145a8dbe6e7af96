/// Does the linear analysis of a part still hold, and can it be made?
#pragma once

#include <string>
#include <vector>

#include "pipeline/forward/eigen_figures.h"
#include "pipeline/forward/stress_figures.h"

namespace meniscus::forward {

/// Sentences for stress above yield (the place with the least safety factor,
/// each body against its own material), for displacements that are not small
/// against the part, for peaks without limit, for those where the material is
/// one element thick, and for walls and shells that are better the other
/// (pipeline/shells/shell_advice.h).
/// `stress`: stress_figures() of the fields, every load case.
std::vector<std::string> part_warnings(
    const case_data::Case& input, const EvaluationFields& fields,
    const std::vector<StressFigures>& stress);

/// A sentence where the mesh chooses a settled film's shape: its lowest mode is
/// next to free, as that of a drop which has more liquid than its curves hold
/// upright and hangs to any side.
std::vector<std::string> film_warnings(const case_data::Case& input,
                                       const settle::FilmReport& film);

/// Sentences for walls thicker than is safe at the design they are frozen at.
std::vector<std::string> wall_warnings(const ForwardModel& model);

/// A sentence where the part is thinner than its [process] can make, by more
/// than flat facets leave in doubt, with the place and how much of it is.
std::vector<std::string> process_warnings(const case_data::Case& input,
                                          const TetMesh& mesh);

/// Sentences for responses of kind buckling_factor whose mode does not matter
/// (buckling_verdict.h).
std::vector<std::string> factor_warnings(const EvaluationFields& fields);

/// Sentences for buckling factors below 1 or near it, and for eigenvalues that
/// could not be found.
std::vector<std::string> eigen_warnings(const EigenFigures& figures);

}  // namespace meniscus::forward
