/// What the buckling factors of a load case mean for the part
/// (docs/decisions/0021-buckling-that-matters.md).
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "fea/modes/buckling.h"
#include "fea/modes/mode_shapes.h"

namespace meniscus::modes {

/// Of one load case.
struct BucklingFigures {
  std::string load_case;
  BucklingModes modes;  // as many as the case asks for, or the first
  /// Per factor: of the loads as they are, where its mode is pushed on.
  std::vector<ModeStress> stresses;
  /// Per factor, the mesh's own error; empty: not estimated.
  std::vector<double> errors;
  /// Unasked, and without convergence in a search as long as a solve.
  bool roughly = false;
};

enum class BucklingVerdict {
  None,         // no factor that was looked for
  BeyondYield,  // none that matters: the material gives way long before
  Stands,       // the factor less its error is 1 or above
  Buckles,      // the factor with its error is below 1
  Uncertain     // 1 is within the error, or the factor has none
};

/// "none", "beyond_yield", ... of result.json.
const char* name_of(BucklingVerdict verdict);

/// sqrt(yield / (factor x von Mises stress)): below 1 the material yields
/// before the part buckles; not a number without a yield strength.
double slenderness(const BucklingFigures& figures, std::size_t factor);

/// True where the stress at the factor is one that the material may reach: a
/// slenderness above 0.2 (EN 1993-1-1:2005, 6.3.1.2(4), below which buckling
/// may be left out) and an elastic strain of no more than 0.1, beyond which
/// linear elasticity says nothing of any material. Modes at edges without a
/// limit of stress do not.
bool matters(const BucklingFigures& figures, std::size_t factor);

/// How many of the smallest factors matter, up to the first that does not.
std::size_t factors_that_matter(const BucklingFigures& figures);

/// Error of a factor; not a number where it was not estimated.
double error_of(const BucklingFigures& figures, std::size_t factor);

BucklingVerdict verdict_of(const BucklingFigures& figures);

/// The factor that no buckling that matters is below: of BeyondYield the
/// smallest of all, of others the first less its error, of None where the
/// search ended; 0 where nothing is known.
double safe_factor(const BucklingFigures& figures);

/// A line for people, without its end: factors with their errors, or what no
/// buckling that matters is below. `figures` must have one or a reason.
std::string buckling_text(const BucklingFigures& figures);

/// Sentences for a part that buckles, or may: factors below 1 or within their
/// error of it, and factors that could not be found.
std::vector<std::string> buckling_warnings(const BucklingFigures& figures);

}  // namespace meniscus::modes
