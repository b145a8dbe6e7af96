/// Responses of stress beside the peak that they are bounded for.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "pipeline/forward/stress_figures.h"

namespace meniscus::forward {

/// A response of von Mises stress, and the peak that it is to keep low. Means
/// over the volume (von_mises_norm, von_mises_ks) lie below the peak as a rule;
/// a stress_ratio lies above both nodal readings of it, and below another
/// reading only where that is far off.
struct NormPeak {
  int response = 0;       // index
  double value = 0.0;     // of the response
  bool is_ratio = false;  // over what is allowed [1]; else [pressure]
  std::string load_case;
  double peak = 0.0;  // in the response's unit, of what counts: recovered; of a
                      // ratio the largest of all readings
  Vec3 position = Vec3::Zero();  // of the peak [length]
  /// Of the study: on the response, or on an envelope that it is part of.
  double bound = std::numeric_limits<double>::infinity();

  /// Kept by the response and not by the peak.
  bool hides_peak() const {
    constexpr double kKept = 1e-3;  // of the bound, as a study keeps it
    return value <= (1.0 + kKept) * bound && peak > (1.0 + kKept) * bound;
  }
};

/// In the responses' order; none without responses or stresses.
std::vector<NormPeak> norm_peaks(const case_data::Case& input,
                                 const VectorX& responses,
                                 const std::vector<StressFigures>& stress);

/// For each whose bound the peak exceeds though the response keeps it.
std::vector<std::string> norm_warnings(const case_data::Case& input,
                                       const std::vector<NormPeak>& peaks);

/// A line for people: what it is, its value, the peak, whether that is within
/// the bound.
std::string norm_text(const case_data::Case& input, const NormPeak& peak);

}  // namespace meniscus::forward
