/// Loads that come from any direction, as they are shown: from the one that
/// stresses the part most, a load case beside those that are solved.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/forward/forward_model.h"

namespace meniscus::forward {

/// The stresses of all load cases of the fields; behind them, for each of the
/// case's loads from any direction, a load case by its name from the worst one:
/// load, displacement, reactions and stress. That is where the largest ratio of
/// von Mises stress to yield is, or the largest stress where a material has no
/// yield strength. Call it once.
void find_stresses(const case_data::Case& input, EvaluationFields& fields);

/// The same load cases behind those of the design that `result` is of: a
/// result.json, whose "stress" tells each one's "direction".
void add_worst_cases(const case_data::Case& input,
                     const nlohmann::ordered_json& result,
                     case_data::EvaluatedCase& inputs);

/// Of a load from any direction that is shown by its worst: no load of the case
/// need be this one.
bool is_unit_load(const EvaluationFields& fields, std::size_t load_case);

/// Those of the fields that were solved, which a model knows.
std::vector<loads::LoadCase> solved_load_cases(const EvaluationFields& fields);

}  // namespace meniscus::forward
