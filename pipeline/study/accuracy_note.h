/// What a study asked for finer than its mesh knows it.
#pragma once

#include <string>

#include "pipeline/case_data/case.h"
#include "pipeline/study/match_targets.h"

namespace meniscus::study {

/// A sentence where the study's tolerance is below the mesh's own error of what
/// it made equal or small, or a constraint is kept or missed by less than its
/// error; "" where nothing is, and for studies without a tolerance. `targets`:
/// of a match, else null. `responses` of the best design, with their errors
/// (one each, in their units; empty: not known).
std::string accuracy_note(const case_data::Case& input,
                          const MatchTargets* targets, const VectorX& responses,
                          const VectorX& errors);

}  // namespace meniscus::study
