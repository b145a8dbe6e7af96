#include "pipeline/forward/work_estimate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/memory.h"

namespace meniscus::forward {

namespace {

constexpr double kElementsPerCube = 8.2;
constexpr double kElementsPerFacet = 1.5;
constexpr double kBytesPerElement = 4200.0;
// Of shells: one factor, or substructures whose factors are not kept
// (docs/performance.md, Shells).
constexpr double kBytesPerFacet = 46000.0;
constexpr double kBytesPerCutFacet = 15000.0;
constexpr double kBytesUncut = 3e8;
constexpr double kMostElements = 1e8;  // numbers of unknowns are int
constexpr double kSmall = 3e7;         // [byte] not worth a question

/// "110,000": two digits that count.
std::string rounded(double count) {
  if (!(count < 1e12)) {
    return fmt::format("{:.1g}", count);
  }
  const double unit =
      std::pow(10.0, std::max(0.0, std::floor(std::log10(count)) - 1.0));
  std::string digits = fmt::format("{:.0f}", std::round(count / unit) * unit);
  for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0;
       at -= 3) {
    digits.insert(static_cast<std::size_t>(at), ",");
  }
  return digits;
}

}  // namespace

WorkEstimate estimate_work(double volume, std::size_t facets, double edge) {
  const double elements =
      std::max({1.0, kElementsPerFacet * static_cast<double>(facets),
                kElementsPerCube * std::abs(volume) / std::pow(edge, 3)});
  return {elements, kBytesPerElement * elements};
}

WorkEstimate estimate_work(const case_data::Case& input,
                           const case_data::EvaluatedCase& inputs,
                           double edge) {
  double volume = 0.0;
  for (const case_data::BodyEntry& body : case_data::solid_bodies(input)) {
    for (const films::BodySpec& spec : inputs.film_system.bodies) {
      volume += spec.name == body.name ? spec.volume.value_or(0.0) : 0.0;
    }
  }
  return estimate_work(volume, 0, edge);
}

std::string text_of(const WorkEstimate& work) {
  return fmt::format("about {} elements, {:.2g} GB", rounded(work.elements),
                     work.bytes / 1e9);
}

void require_work(const WorkEstimate& work, double edge) {
  if (work.bytes <= kSmall) {
    return;
  }
  const double free = available_memory();
  if (work.bytes <= free && work.elements <= kMostElements) {
    return;
  }
  const double most = std::min(free / kBytesPerElement, kMostElements);
  throw InvalidInput(fmt::format(
      "the part needs {} at edges of {:.4g} (resolution.fea), and {:.2g} GB "
      "are "
      "free; edges of {:.2g} would fit, if no volume or place of a curve is "
      "wrong",
      text_of(work), edge, free / 1e9,
      1.05 * edge * std::cbrt(work.elements / most)));
}

void require_shell_work(std::size_t facets, double edge, bool beside_solids) {
  const auto count = static_cast<double>(facets);
  const double whole = kBytesPerFacet * count;
  const double bytes =
      beside_solids ? whole
                    : std::min(whole, kBytesPerCutFacet * count + kBytesUncut);
  const double free = available_memory();
  if (bytes <= kSmall || bytes <= free) {
    return;
  }
  throw InvalidInput(fmt::format(
      "the shell needs about {} facets, {:.2g} GB, at edges of {:.4g} "
      "(resolution.fea), and {:.2g} GB are free; edges of {:.2g} would fit",
      rounded(count), bytes / 1e9, edge, free / 1e9,
      1.05 * edge * std::sqrt(bytes / free)));
}

void require_work(const case_data::Case& input) {
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  require_work(estimate_work(input, inputs, inputs.fea_edge), inputs.fea_edge);
}

}  // namespace meniscus::forward
