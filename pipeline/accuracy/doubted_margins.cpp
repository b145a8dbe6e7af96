#include "pipeline/accuracy/doubted_margins.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace meniscus::accuracy {

bool holds_margin(const case_data::Case& input,
                  const case_data::ConstraintEntry& entry) {
  return input.responses[static_cast<std::size_t>(entry.response)].kind ==
             case_data::ResponseKind::CollapseMargin &&
         std::isfinite(entry.lower);
}

std::vector<DoubtedMargin> doubted_margins(const case_data::Case& input,
                                           const VectorX& responses,
                                           const VectorX& errors) {
  std::vector<DoubtedMargin> doubted;
  const auto& constraints = input.study.constraints;
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    const int response = constraints[k].response;
    // An error that is not known keeps nothing.
    if (holds_margin(input, constraints[k]) &&
        !(responses[response] > errors[response])) {
      doubted.push_back(
          {.constraint = k,
           .name = input.responses[static_cast<std::size_t>(response)].name,
           .value = responses[response],
           .error = errors[response],
           .shown = case_data::shown_unit(input, response)});
    }
  }
  return doubted;
}

std::string doubt_text(const DoubtedMargin& margin) {
  return std::isfinite(margin.error) ? "the mesh's own error of it is " +
                                           margin.shown.text(margin.error, 2)
                                     : "other facets have no such film";
}

double raised_bound(const DoubtedMargin& margin, double lower) {
  // The error falls as the margin grows: far from the collapse another mesh
  // moves the film less. A wild one must not send the study to designs of no
  // use.
  constexpr double kAboveError = 1.25;
  constexpr double kLeastRaise = 1.25;
  constexpr double kMostRaise = 1.5;
  const double held = std::max(margin.value, lower);
  return std::isfinite(margin.error)
             ? std::clamp(kAboveError * margin.error, kLeastRaise * held,
                          kMostRaise * held)
             : kMostRaise * held;
}

}  // namespace meniscus::accuracy
