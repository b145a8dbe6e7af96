/// Margins to collapse whose bounds are not kept with the mesh's own error of
/// them: on shorter edges they may be missed, or the film may not be there.
#pragma once

#include <string>
#include <vector>

#include "core/math/dense.h"
#include "pipeline/case_data/case.h"

namespace meniscus::accuracy {

struct HeldMargin {
  std::size_t constraint = 0;  // index into the study's
  std::string name;            // of the response
  double value = 0.0;          // [stress / length]
  double error = 0.0;    // of it; NaN where other facets have no such film
  double lower = 0.0;    // the case's bound
  ShownUnit shown = {};  // of all three, in messages
};

/// A bound from below that keeps a film from its collapse.
bool holds_margin(const case_data::Case& input,
                  const case_data::ConstraintEntry& entry);

/// Those of the study's bounds; values and errors of the responses in the
/// case's order.
std::vector<HeldMargin> held_margins(const case_data::Case& input,
                                     const VectorX& responses,
                                     const VectorX& errors);

/// Those that the margin less its error misses.
std::vector<HeldMargin> doubted_margins(const case_data::Case& input,
                                        const VectorX& responses,
                                        const VectorX& errors);

/// Why it is doubted, as the end of a sentence.
std::string doubt_text(const HeldMargin& margin);

/// A search that goes on from there may end on that bound.
bool is_near_bound(double margin, double lower);

/// What its bound is raised to, from `lower` > 0, for the search to go on with:
/// where the margin less its error keeps the case's bound (margin_to_hold())
/// and a little above, by half at most; by half where the film may not be there
/// on other facets.
double raised_bound(const HeldMargin& margin, double lower);

/// The same of a margin that may keep it, before the search goes on: `lower`
/// where it is far above, or its error says nothing.
double foreseen_bound(const HeldMargin& margin, double lower);

}  // namespace meniscus::accuracy
