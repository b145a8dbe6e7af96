/// Margins to collapse that the mesh's own error of them makes nothing: the
/// film may be there on this mesh alone.
#pragma once

#include <string>
#include <vector>

#include "core/math/dense.h"
#include "pipeline/case_data/case.h"

namespace meniscus::accuracy {

struct DoubtedMargin {
  std::size_t constraint = 0;  // index into the study's
  std::string name;            // of the response
  double value = 0.0;          // [stress / length]
  double error = 0.0;    // of it; NaN where other facets have no such film
  ShownUnit shown = {};  // of both, in messages
};

/// A bound from below that keeps a film from its collapse.
bool holds_margin(const case_data::Case& input,
                  const case_data::ConstraintEntry& entry);

/// Those of the study's bounds whose margin is not above its error; values and
/// errors of the responses in the case's order.
std::vector<DoubtedMargin> doubted_margins(const case_data::Case& input,
                                           const VectorX& responses,
                                           const VectorX& errors);

/// Why it is doubted, as the end of a sentence.
std::string doubt_text(const DoubtedMargin& margin);

/// What its bound is raised to, from `lower` > 0, for the search to go on with:
/// above the error by a quarter, but by a quarter at least and by half at most;
/// by half where other facets have no such film.
double raised_bound(const DoubtedMargin& margin, double lower);

}  // namespace meniscus::accuracy
