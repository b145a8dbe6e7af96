/// The exact gradient of a case's responses against central differences.
#pragma once

#include <string>
#include <vector>

#include "optimize/check_gradient.h"
#include "pipeline/case_data/case.h"

namespace meniscus::forward {

struct CaseGradientCheck {
  VectorX design;  // where
  optimize::GradientCheckReport report;
  std::vector<std::string> left_out;  // responses without derivatives
  /// Vectors of which not every element was looked at: "t [8 x 12]: 8 of its 96
  /// elements at random and a direction of them all".
  std::vector<std::string> sampled;
  double evaluation_seconds = 0.0;  // of the design, a next one
  double gradient_seconds = 0.0;    // of all responses together
};

/// Freezes the case's model, differentiates at `design` (within the bounds) and
/// compares: by each variable, of a vector of more than 8 elements by 8 of them
/// and along a direction of them all, the same random ones in each run, or
/// along so many random `directions` of all of them together, the same in each
/// run, each to the first bound that it meets (a few evaluations for a case of
/// many variables; a wrong derivative shows in all of them). Throws
/// InvalidInput for a case without design variables, without responses that
/// have derivatives, or a design of another size; MeshError or SolverError when
/// `design` cannot be evaluated.
CaseGradientCheck check_case_gradient(
    const case_data::Case& input, const VectorX& design,
    const optimize::GradientCheckOptions& options = {}, int directions = 0);

/// The table for people: one line per response and variable, and the verdict.
std::string gradient_check_text(const case_data::Case& input,
                                const CaseGradientCheck& check);

}  // namespace meniscus::forward
