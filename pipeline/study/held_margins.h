/// Margins to collapse that a study holds by more than their bounds, for the
/// mesh's own error of them: else the film may be there on one mesh alone
/// (internal to run_study()).
#pragma once

#include <vector>

#include "pipeline/accuracy/doubted_margins.h"
#include "pipeline/accuracy/mesh_sequence.h"
#include "pipeline/case_data/case.h"
#include "pipeline/study/study.h"

namespace meniscus::study {

/// The study seeks a least figure and holds a margin above zero.
bool holds_margins(const case_data::Case& working);

/// A search that goes on from a design with these responses may end on the
/// bound of one.
bool nears_margins(const case_data::Case& working, const VectorX& responses);

/// In the warning of a margin whose bound was raised.
inline constexpr const char* kHeldAbove = ", above its bound";

struct RaisedMargin {
  accuracy::HeldMargin margin;
  double lower = 0.0;  // its bound, above the case's
};

enum class Raise {
  Doubted,  // of an answer: those that it does not keep with their errors
  Foreseen  // of a design from which a search goes on: all, by their errors
};

/// Raises the bounds of margins in `working`, by `errors` of the design's
/// responses (not a number where no other mesh has a film).
std::vector<RaisedMargin> raise_margins(const case_data::Case& input,
                                        const VectorX& responses,
                                        const VectorX& errors, Raise raise,
                                        case_data::Case& working);

/// A margin of the result that misses its bound by its own error does not keep
/// it.
void doubt_margins(const case_data::Case& input, RunResult& result);

}  // namespace meniscus::study
