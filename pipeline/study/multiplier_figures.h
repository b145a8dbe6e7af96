/// What the bounds that hold a minimum are worth, for people and programs.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "optimize/multipliers.h"
#include "pipeline/case_data/case.h"

namespace meniscus::study {

/// The part `multipliers` of result.json (docs/results.md).
nlohmann::ordered_json multipliers_json(const case_data::Case& input,
                                        const optimize::Multipliers& found);

/// A line per bound that binds, one of all of a vector on one side: by how much
/// the objective, which is `objective` at the minimum, falls where the bound
/// gives way by 1 % of itself, one of 0 by a thousandth of the unit that it is
/// shown in.
std::string multipliers_text(const case_data::Case& input,
                             const optimize::Multipliers& found,
                             double objective);

}  // namespace meniscus::study
