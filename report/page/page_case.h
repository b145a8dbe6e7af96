/// What the report page says of the case behind a run.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/case_data/case.h"
#include "pipeline/store/study_store.h"

namespace meniscus::page {

/// Path, text and overrides, and design variables, responses and the study
/// with names and units.
nlohmann::ordered_json page_case(const case_data::Case& input);

/// The boundary curves at a design: `closed` points of each, and `motion`, how
/// far each point moves per unit of every design variable that moves it. What
/// cannot be evaluated there is left out.
nlohmann::ordered_json page_curves(const case_data::Case& input,
                                   const VectorX& design);

/// What acts on the part and holds it, per load case: `on` a surface, `kind`
/// "force", "moment", "pressure", "traction", "support", "spring", and its
/// `vector` [force] where it has one.
nlohmann::ordered_json page_loads(const case_data::Case& input,
                                  const case_data::EvaluatedCase& inputs);

/// The derivatives of the responses at the evaluation with exact gradients
/// that is nearest to the design, in parts of the variables' ranges; null when
/// no evaluation has them.
nlohmann::ordered_json page_gradients(
    const case_data::Case& input,
    const std::vector<store::EvaluationRecord>& records, const VectorX& design);

}  // namespace meniscus::page
