#include "pipeline/forward/fillets.h"

#include <fmt/format.h>

namespace meniscus::forward {

namespace {

/// "case.toml:12: " of the fillet that the message names.
std::string line_of(const case_data::Case& input, const std::string& message) {
  for (const case_data::FilletEntry& fillet : input.fillets) {
    if (message.rfind(fmt::format("fillet '{}'", fillet.name), 0) == 0) {
      return case_data::place(input, fillet.line) + ": ";
    }
  }
  return "";
}

}  // namespace

std::optional<fillets::FilletModel> fillet_model(
    const case_data::Case& input, const case_data::EvaluatedCase& inputs,
    const frozen::FilmModel& model, const Points& points,
    std::optional<Failure>& failure) {
  if (inputs.film_system.fillets.empty()) {
    return std::nullopt;
  }
  try {
    return fillets::FilletModel::freeze(model, inputs.film_system, points);
  } catch (const InvalidInput& error) {
    failure = fillet_failure(input, error);
  }
  return std::nullopt;
}

Failure fillet_failure(const case_data::Case& input,
                       const InvalidInput& error) {
  return {FailureKind::SurfaceInvalid,
          line_of(input, error.what()) + error.what()};
}

Points rounded_anew(const films::FilmSystem& system,
                    const frozen::FilmModel& model, const Points& points) {
  return system.fillets.empty()
             ? points
             : fillets::FilletModel::freeze(model, system, points)
                   .rounded(points, system);
}

}  // namespace meniscus::forward
