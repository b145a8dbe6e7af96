#include "pipeline/forward/norm_peaks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/count_text.h"
#include "pipeline/case_data/response_entries.h"

namespace meniscus::forward {

namespace {

using case_data::ResponseEntry;
using case_data::ResponseKind;

bool is_mean(const ResponseEntry& response) {
  return response.kind == ResponseKind::VonMisesNorm ||
         response.kind == ResponseKind::VonMisesKs;
}

bool is_von_mises_ratio(const ResponseEntry& response) {
  return response.kind == ResponseKind::StressRatio &&
         response.stress == case_data::StressMeasure::VonMises;
}

/// The least upper bound that the study has on a response or on an envelope
/// that is never below it.
double bound_of(const case_data::Case& input, int response) {
  double bound = std::numeric_limits<double>::infinity();
  for (const case_data::ConstraintEntry& entry : input.study.constraints) {
    const ResponseEntry& of =
        input.responses[static_cast<std::size_t>(entry.response)];
    const bool covers = !of.least && std::find(of.parts.begin(), of.parts.end(),
                                               response) != of.parts.end();
    if (entry.response == response || covers) {
      bound = std::min(bound, entry.upper);
    }
  }
  return bound;
}

/// The peak over what is allowed, by whichever reading is largest.
void set_ratio(const ResponseEntry& response, const StressFigures& figures,
               NormPeak& peak) {
  peak.is_ratio = true;
  if (response.allowable) {
    const stress::Peak& largest = figures.readings.largest();
    peak.peak = largest.von_mises / *response.allowable;
    peak.position = largest.position;
  } else if (figures.safety) {
    peak.peak = 1.0 / figures.safety->factor;
    peak.position = figures.safety->position;
  }
}

std::string shown(const case_data::Case& input, const NormPeak& peak,
                  double value) {
  return quantity_text(value, peak.is_ratio ? "" : input.units.pressure, 4);
}

}  // namespace

std::vector<NormPeak> norm_peaks(const case_data::Case& input,
                                 const VectorX& responses,
                                 const std::vector<StressFigures>& stress) {
  std::vector<NormPeak> peaks;
  for (int k = 0; k < static_cast<int>(input.responses.size()); ++k) {
    const ResponseEntry& response =
        input.responses[static_cast<std::size_t>(k)];
    const std::size_t load_case = case_data::shown_load_case(input, response);
    if ((!is_mean(response) && !is_von_mises_ratio(response)) ||
        k >= responses.size() || load_case >= stress.size()) {
      continue;
    }
    const StressFigures& figures = stress[load_case];
    NormPeak peak{.response = k,
                  .value = responses[k],
                  .load_case = figures.load_case,
                  .peak = figures.max_von_mises,
                  .position = figures.position,
                  .bound = bound_of(input, k)};
    if (!is_mean(response)) {
      set_ratio(response, figures, peak);
    }
    peaks.push_back(std::move(peak));
  }
  return peaks;
}

std::vector<std::string> norm_warnings(const case_data::Case& input,
                                       const std::vector<NormPeak>& peaks) {
  std::vector<std::string> warnings;
  for (const NormPeak& peak : peaks) {
    if (!peak.hides_peak()) {
      continue;
    }
    const ResponseEntry& response =
        input.responses[static_cast<std::size_t>(peak.response)];
    const char* const advice =
        peak.is_ratio ? "a smaller resolution.fea brings the readings together"
        : response.kind == ResponseKind::VonMisesKs
            ? "bound the mean lower, or make its sharpness larger"
            : "bound the mean lower, or make its power larger";
    warnings.push_back(fmt::format(
        "'{}' keeps its bound and the peak does not: the {} is {}, its bound "
        "{}, and the {} of load case '{}' {} at ({:.4g}, {:.4g}, {:.4g}). Look "
        "at that place (at a clamped edge a peak grows with every refinement: "
        "leave it out by analysis.exclude); else {}",
        response.name,
        peak.is_ratio ? "bound of nodal stress over what is allowed"
                      : "mean over the volume",
        shown(input, peak, peak.value), shown(input, peak, peak.bound),
        peak.is_ratio ? "largest reading" : "nodal peak", peak.load_case,
        shown(input, peak, peak.peak), peak.position.x(), peak.position.y(),
        peak.position.z(), advice));
  }
  return warnings;
}

std::string norm_text(const case_data::Case& input, const NormPeak& peak) {
  return fmt::format(
      "  {:<20} is {}, {}; the {} of '{}' is {}{}\n",
      input.responses[static_cast<std::size_t>(peak.response)].name,
      peak.is_ratio          ? "a bound of the nodal peak over what is allowed"
      : input.shells.empty() ? "a mean over the volume"
                             : "a mean over both faces",
      shown(input, peak, peak.value),
      peak.is_ratio ? "largest reading" : "nodal peak", peak.load_case,
      shown(input, peak, peak.peak),
      !std::isfinite(peak.bound) ? ""
      : peak.peak > peak.bound   ? ", ABOVE the bound"
                                 : ", within the bound");
}

}  // namespace meniscus::forward
