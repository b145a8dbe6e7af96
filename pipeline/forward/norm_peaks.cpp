#include "pipeline/forward/norm_peaks.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/count_text.h"

namespace meniscus::forward {

std::vector<NormPeak> norm_peaks(const case_data::Case& input,
                                 const VectorX& responses,
                                 const std::vector<StressFigures>& stress) {
  std::vector<NormPeak> peaks;
  for (int k = 0; k < static_cast<int>(input.responses.size()); ++k) {
    const case_data::ResponseEntry& response =
        input.responses[static_cast<std::size_t>(k)];
    const auto load_case = static_cast<std::size_t>(response.load_case);
    if ((response.kind != case_data::ResponseKind::VonMisesNorm &&
         response.kind != case_data::ResponseKind::VonMisesKs) ||
        k >= responses.size() || load_case >= stress.size()) {
      continue;
    }
    const StressFigures& figures = stress[load_case];
    NormPeak peak{.response = k,
                  .value = responses[k],
                  .load_case = figures.load_case,
                  .peak = figures.max_von_mises,
                  .position = figures.position};
    for (const case_data::ConstraintEntry& entry : input.study.constraints) {
      if (entry.response == k) {
        peak.bound = std::min(peak.bound, entry.upper);
      }
    }
    peaks.push_back(std::move(peak));
  }
  return peaks;
}

std::vector<std::string> norm_warnings(const case_data::Case& input,
                                       const std::vector<NormPeak>& peaks) {
  std::vector<std::string> warnings;
  const std::string& unit = input.units.pressure;
  for (const NormPeak& peak : peaks) {
    if (peak.hides_peak()) {
      const case_data::ResponseEntry& response =
          input.responses[static_cast<std::size_t>(peak.response)];
      warnings.push_back(fmt::format(
          "'{}' keeps its bound and the peak does not: the mean over the "
          "volume is {}, its bound {}, and the nodal peak of load case '{}' "
          "{} at ({:.4g}, {:.4g}, {:.4g}). Look at that place (at a clamped "
          "edge a peak grows with every refinement: leave it out by "
          "analysis.exclude); else bound the mean lower, or make {} larger",
          response.name, quantity_text(peak.value, unit, 4),
          quantity_text(peak.bound, unit, 4), peak.load_case,
          quantity_text(peak.peak, unit, 4), peak.position.x(),
          peak.position.y(), peak.position.z(),
          response.kind == case_data::ResponseKind::VonMisesKs ? "its sharpness"
                                                               : "its power"));
    }
  }
  return warnings;
}

}  // namespace meniscus::forward
