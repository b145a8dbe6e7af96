/// Materials, supports and loads of a case at one design.
#pragma once

#include "pipeline/case_data/case.h"
#include "pipeline/case_data/case_values.h"

namespace meniscus::case_data {

/// What has no good value is told in values.problems().
element::Material material_of(const Case& input, const MaterialEntry& entry,
                              const CaseValues& values);
loads::LoadCase load_case_of(const LoadCaseEntry& entry,
                             const CaseValues& values);

/// The same surfaces, in any order.
bool are_same_surfaces(const loads::Surfaces& a, const loads::Surfaces& b);

/// Some load or enforced displacement of it is not 0 (expressions of the place
/// count as loads).
bool is_loaded(const loads::LoadCase& load_case);

/// Density matters to how the part is loaded: gravity or spin acts.
bool has_weight(const loads::LoadCase& load_case);

}  // namespace meniscus::case_data
