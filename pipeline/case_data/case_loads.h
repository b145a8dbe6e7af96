/// Materials, supports and loads of a case at one design.
#pragma once

#include "pipeline/case_data/case.h"
#include "pipeline/case_data/case_values.h"

namespace meniscus {

/// What has no good value is told in values.problems().
Material material_of(const Case& input, const MaterialEntry& entry,
                     const CaseValues& values);
LoadCase load_case_of(const LoadCaseEntry& entry, const CaseValues& values);

/// Some load of it is not 0 (expressions of the place count as loads).
bool is_loaded(const LoadCase& load_case);

/// Density matters to how the part is loaded: gravity or spin acts.
bool has_weight(const LoadCase& load_case);

}  // namespace meniscus
