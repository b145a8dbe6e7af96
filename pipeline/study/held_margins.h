/// Margins to collapse that a study holds, where the mesh's own error of them
/// makes them nothing: the film may be there on one mesh alone (internal to
/// run_study()).
#pragma once

#include <vector>

#include "pipeline/accuracy/doubted_margins.h"
#include "pipeline/accuracy/mesh_sequence.h"
#include "pipeline/case_data/case.h"
#include "pipeline/study/study.h"

namespace meniscus::study {

/// The study seeks a least figure and holds a margin above zero.
bool holds_margins(const case_data::Case& working);

/// In the warning of a margin whose bound was raised.
inline constexpr const char* kHeldAbove = ", above its bound";

struct RaisedMargin {
  accuracy::DoubtedMargin margin;
  double lower = 0.0;  // its bound, above the margin's error
};

/// Raises the bounds in `working` of those margins of an answer that `errors`
/// (of its responses, not a number where no other mesh has a film) make
/// doubtful.
std::vector<RaisedMargin> raise_margins(const case_data::Case& input,
                                        const VectorX& responses,
                                        const VectorX& errors,
                                        case_data::Case& working);

/// A margin of the result that its own error makes nothing is no margin: its
/// bound is not kept.
void doubt_margins(const case_data::Case& input, RunResult& result);

}  // namespace meniscus::study
