/// How each kind of response is computed, with its partial derivatives.
#pragma once

#include <vector>

#include "fea/functionals/nodal_peak.h"
#include "pipeline/case_data/response_kinds.h"
#include "pipeline/responses/responses.h"

namespace meniscus::responses {

/// One response of one design, on loan.
struct ResponseTask {
  const case_data::ResponseEntry& response;
  const case_data::ResponseInputs& inputs;
  const ResponseContext& fields;
  element::Derivatives derivatives;
};

/// Of every kind but expressions of other responses.
ResponsePartials compute_partials(const ResponseTask& task);

// Of kinds stress_ratio and fatigue, in strength_partials.cpp:
ResponsePartials stress_ratio(const ResponseTask& task);
ResponsePartials fatigue(const ResponseTask& task);

/// Of shells, in shell_partials.cpp: none for what they have as solids do, of
/// faces and films.
std::optional<ResponsePartials> shell_partials(const ResponseTask& task);

/// Without load cases.
ResponsePartials shell_to_partials(const shells::ShellPart& part,
                                   shell::ShellGradient gradient);

/// Of a load case, 3 per node: its loads' work and strain energy.
ResponsePartials energy_of(const ResponseTask& task,
                           const loads::LoadCase& load_case, const VectorX& u);

/// Of the worst direction of a load from any, in worst_partials.cpp: all that
/// case_data::knows_worst_direction() says.
ResponsePartials worst_partials(const ResponseTask& task);

/// Nodal peak of states of load cases, in their order.
ResponsePartials nodal_peak_partials(
    const ResponseTask& task, const std::vector<int>& load_cases,
    const functionals::NodeCriterion& criterion);

/// Per region, of kind stress_ratio [pressure].
std::vector<double> allowable_stress(const ResponseTask& task);

/// Of gaps, x the edge, where the case says nothing else: films run beside each
/// other over wide areas, and many edges count.
inline constexpr double kGapSmoothing = 0.01;

/// Of grooves [rad]: with a few hundred edges as deep as the deepest the value
/// is three degrees above it.
inline constexpr double kGrooveSmoothing = 0.01;

/// Of von_mises_ks: the case's, else the least yield strength [pressure].
double ks_scale(const case_data::ResponseEntry& response,
                const std::vector<element::Material>& materials);

/// Of extremes over the part's surface, where the case says nothing else: to a
/// tenth of an edge [1/length].
double sharpness_of(const case_data::ResponseEntry& response,
                    const ResponseContext& fields);

}  // namespace meniscus::responses
