#include "pipeline/accuracy/doubted_margins.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "pipeline/accuracy/mesh_errors.h"

namespace meniscus::accuracy {

namespace {

constexpr double kRounding = 1e-6;  // of a bound; as much as a search misses
// Errors differ between designs: the bound is raised by so much more than one
// asks for, and by so much at least where a raise was not enough. A wild error
// must not send the study to designs of no use.
constexpr double kBeyond = 1.25;
constexpr double kLeastRaise = 1.02;
constexpr double kMostRaise = 1.5;
constexpr double kNear = 2.0;  // x its bound; a margin above may stay there

bool is_doubted(const HeldMargin& margin) {
  // An error that is not known keeps nothing.
  return !(margin.value - margin.error >=
           margin.lower - kRounding * std::abs(margin.lower));
}

/// NaN where the error is the whole margin.
double wanted_bound(const HeldMargin& margin) {
  return margin.error < margin.value
             ? margin.lower +
                   kBeyond * (margin_to_hold(margin.lower, margin.value,
                                             margin.error) -
                              margin.lower)
             : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

bool holds_margin(const case_data::Case& input,
                  const case_data::ConstraintEntry& entry) {
  return input.responses[static_cast<std::size_t>(entry.response)].kind ==
             case_data::ResponseKind::CollapseMargin &&
         std::isfinite(entry.lower);
}

std::vector<HeldMargin> held_margins(const case_data::Case& input,
                                     const VectorX& responses,
                                     const VectorX& errors) {
  std::vector<HeldMargin> held;
  const auto& constraints = input.study.constraints;
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    if (holds_margin(input, constraints[k])) {
      const int response = constraints[k].response;
      held.push_back(
          {.constraint = k,
           .name = input.responses[static_cast<std::size_t>(response)].name,
           .value = responses[response],
           .error = errors[response],
           .lower = constraints[k].lower,
           .shown = case_data::shown_unit(input, response)});
    }
  }
  return held;
}

std::vector<HeldMargin> doubted_margins(const case_data::Case& input,
                                        const VectorX& responses,
                                        const VectorX& errors) {
  std::vector<HeldMargin> margins = held_margins(input, responses, errors);
  std::erase_if(margins,
                [](const HeldMargin& margin) { return !is_doubted(margin); });
  return margins;
}

std::string doubt_text(const HeldMargin& margin) {
  return std::isfinite(margin.error) ? "the mesh's own error of it is " +
                                           margin.shown.text(margin.error, 2)
                                     : "other facets have no such film";
}

double raised_bound(const HeldMargin& margin, double lower) {
  const double held = std::max(margin.value, lower);
  const double wanted = wanted_bound(margin);
  return std::isfinite(wanted)
             ? std::clamp(wanted, kLeastRaise * held, kMostRaise * held)
             : kMostRaise * held;
}

bool is_near_bound(double margin, double lower) {
  return margin < kNear * lower;
}

double foreseen_bound(const HeldMargin& margin, double lower) {
  const double wanted =
      is_near_bound(margin.value, lower) ? wanted_bound(margin) : lower;
  return std::isfinite(wanted) ? std::clamp(wanted, lower, kMostRaise * lower)
                               : lower;
}

}  // namespace meniscus::accuracy
