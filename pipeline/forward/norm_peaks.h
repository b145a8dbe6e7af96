/// Means of stress over the volume beside the peak that they are bounded for.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "pipeline/forward/stress_figures.h"

namespace meniscus::forward {

/// A response of kind von_mises_norm or von_mises_ks, and what it says nothing
/// of: both are means over the volume and lie below the peak as a rule.
struct NormPeak {
  int response = 0;    // index
  double value = 0.0;  // [pressure]
  std::string load_case;
  double peak = 0.0;             // of nodal stresses that count [pressure]
  Vec3 position = Vec3::Zero();  // of the peak [length]
  double bound = std::numeric_limits<double>::infinity();  // of the study

  /// Kept by the mean and not by the peak.
  bool hides_peak() const {
    constexpr double kKept = 1e-3;  // of the bound, as a study keeps it
    return value <= (1.0 + kKept) * bound && peak > (1.0 + kKept) * bound;
  }
};

/// In the responses' order; none without responses or stresses.
std::vector<NormPeak> norm_peaks(const case_data::Case& input,
                                 const VectorX& responses,
                                 const std::vector<StressFigures>& stress);

/// For each whose bound the peak exceeds though the mean keeps it.
std::vector<std::string> norm_warnings(const case_data::Case& input,
                                       const std::vector<NormPeak>& peaks);

}  // namespace meniscus::forward
