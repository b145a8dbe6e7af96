#include "fea/modes/buckling_verdict.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace meniscus::modes {

namespace {

constexpr double kStocky = 0.2;
constexpr double kLargestStrain = 0.1;
/// Meshes whose factors differ by as much, of the factor, do not agree on it.
constexpr double kAgreed = 0.5;

/// Two digits, never above: "180" of 183.9.
std::string rounded_down(double value) {
  if (!(value > 0.0)) {
    return "0";
  }
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return fmt::format("{:.6g}", unit * std::floor(value / unit * (1.0 + 1e-12)));
}

/// "where the stress is 61 times yield" at a factor.
std::string far_beyond(const BucklingFigures& figures, std::size_t factor) {
  const ModeStress& stress = figures.stresses[factor];
  const double times = figures.modes.factors[factor];
  return std::isfinite(stress.of_yield)
             ? fmt::format("where its stress is {} times yield",
                           rounded_down(times * stress.of_yield))
             : fmt::format("where it is strained by {} %",
                           rounded_down(100.0 * times * stress.strain));
}

/// "3.21 +- 0.12" for each factor that matters.
std::string told_factors(const BucklingFigures& figures) {
  std::vector<std::string> told;
  for (std::size_t k = 0; k < factors_that_matter(figures); ++k) {
    told.push_back(fmt::format("{:.4g} +- {:.2g}", figures.modes.factors[k],
                               error_of(figures, k)));
  }
  return fmt::format("{} x the loads", fmt::join(told, ", "));
}

std::string text_that_matters(const BucklingFigures& figures) {
  const double factor = figures.modes.factors.front();
  const double error = error_of(figures, 0);
  if (!std::isfinite(error)) {
    return fmt::format(
        "{:.3g} x the loads on this mesh alone, whose error is not known",
        factor);
  }
  if (error > kAgreed * factor) {
    return fmt::format(
        "no certain factor: {:.3g} x the loads on this mesh, {} on others",
        factor,
        factor > error
            ? fmt::format("no less than {}", rounded_down(factor - error))
            : std::string("any"));
  }
  std::string text = told_factors(figures);
  if (slenderness(figures, 0) > 1.0) {
    text += ", before it yields";
  }
  const std::size_t count = factors_that_matter(figures);
  if (count < figures.modes.factors.size()) {
    text += fmt::format("; none else that matters below {}",
                        rounded_down(figures.modes.factors[count]));
  }
  return text;
}

}  // namespace

const char* name_of(BucklingVerdict verdict) {
  switch (verdict) {
    case BucklingVerdict::None:
      return "none";
    case BucklingVerdict::BeyondYield:
      return "beyond_yield";
    case BucklingVerdict::Stands:
      return "stands";
    case BucklingVerdict::Buckles:
      return "buckles";
    case BucklingVerdict::Uncertain:
      break;
  }
  return "uncertain";
}

double slenderness(const BucklingFigures& figures, std::size_t factor) {
  return 1.0 / std::sqrt(figures.modes.factors[factor] *
                         figures.stresses[factor].of_yield);
}

bool matters(const BucklingFigures& figures, std::size_t factor) {
  const bool stocky = slenderness(figures, factor) <= kStocky;
  return !stocky &&
         figures.modes.factors[factor] * figures.stresses[factor].strain <=
             kLargestStrain;
}

std::size_t factors_that_matter(const BucklingFigures& figures) {
  std::size_t count = 0;
  while (count < figures.modes.factors.size() && matters(figures, count)) {
    ++count;
  }
  return count;
}

double error_of(const BucklingFigures& figures, std::size_t factor) {
  return factor < figures.errors.size()
             ? figures.errors[factor]
             : std::numeric_limits<double>::quiet_NaN();
}

BucklingVerdict verdict_of(const BucklingFigures& figures) {
  const std::vector<double>& factors = figures.modes.factors;
  if (factors.empty()) {
    return figures.modes.failure ? BucklingVerdict::Uncertain
                                 : BucklingVerdict::None;
  }
  if (figures.modes.failure) {
    return BucklingVerdict::Uncertain;
  }
  if (!matters(figures, 0)) {
    return BucklingVerdict::BeyondYield;
  }
  const double error = error_of(figures, 0);
  if (factors.front() + error < 1.0) {
    return BucklingVerdict::Buckles;
  }
  return factors.front() - error >= 1.0 ? BucklingVerdict::Stands
                                        : BucklingVerdict::Uncertain;
}

double safe_factor(const BucklingFigures& figures) {
  if (figures.modes.failure) {
    return 0.0;
  }
  const std::vector<double>& factors = figures.modes.factors;
  if (factors.empty()) {
    return figures.modes.none_below;
  }
  if (!matters(figures, 0)) {
    // One that came out of a short search may lie above the least.
    return factors.front() /
           (figures.roughly ? 1.0 + figures.modes.residuals.front() : 1.0);
  }
  const double error = error_of(figures, 0);
  return std::isfinite(error) ? std::fmax(factors.front() - error, 0.0) : 0.0;
}

std::string buckling_text(const BucklingFigures& figures) {
  switch (figures.modes.failure ? BucklingVerdict::Uncertain
                                : verdict_of(figures)) {
    case BucklingVerdict::None:
      return fmt::format("none below {:.4g} x the loads",
                         figures.modes.none_below);
    case BucklingVerdict::BeyondYield:
      return fmt::format("none that matters below {} x the loads, {}",
                         rounded_down(safe_factor(figures)),
                         far_beyond(figures, 0));
    default:
      break;
  }
  return figures.modes.failure ? "not converged" : text_that_matters(figures);
}

std::vector<std::string> buckling_warnings(const BucklingFigures& figures) {
  std::vector<std::string> warnings;
  const std::vector<double>& factors = figures.modes.factors;
  const BucklingVerdict verdict = verdict_of(figures);
  if (figures.modes.failure) {
    warnings.push_back("no certain buckling factor: " +
                       figures.modes.failure->message);
  }
  if (factors.empty() || !matters(figures, 0)) {
    return warnings;
  }
  if (factors.front() < 1.0) {
    warnings.push_back(fmt::format(
        "buckling factor below 1: the part of load case '{}' buckles at {:.3g} "
        "of its loads; a linear analysis does not hold",
        figures.load_case, factors.front()));
  } else if (verdict == BucklingVerdict::Uncertain &&
             std::isfinite(error_of(figures, 0))) {
    warnings.push_back(fmt::format(
        "buckling factor within its error of 1: the part of load case '{}' "
        "buckles at {:.3g} +- {:.2g} of its loads; look at shorter edges",
        figures.load_case, factors.front(), error_of(figures, 0)));
  }
  return warnings;
}

}  // namespace meniscus::modes
