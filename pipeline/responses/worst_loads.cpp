#include "pipeline/responses/worst_loads.h"

#include <cmath>

#include <fmt/format.h>

#include "pipeline/case_data/response_entries.h"

namespace meniscus::responses {

std::vector<WorstLoad> worst_loads(const case_data::Case& input,
                                   const ResponseContext& fields) {
  std::vector<WorstLoad> worst;
  for (std::size_t r = 0; r < input.responses.size(); ++r) {
    const case_data::ResponseEntry& response = input.responses[r];
    if (case_data::is_composed(response) || !response.worst_in) {
      continue;
    }
    const auto of = case_data::directions_with(
        input, static_cast<std::size_t>(response.load_case));
    const ResponsePartials partials =
        partials_of(response, fields.inputs.responses[r], fields,
                    element::Derivatives::None);
    worst.push_back({static_cast<int>(r), of->name, *partials.worst_direction});
  }
  return worst;
}

loads::LoadCase combined_load(const std::vector<loads::LoadCase>& load_cases,
                              int first, const Vec3& d) {
  const auto unit = load_cases.begin() + first;
  loads::LoadCase combined = *unit;
  for (std::size_t i = 0; i < combined.forces.size(); ++i) {
    combined.forces[i].total.setZero();
    for (int k = 0; k < 3; ++k) {
      combined.forces[i].total += d[k] * unit[k].forces[i].total;
    }
  }
  for (std::size_t i = 0; i < combined.remote_loads.size(); ++i) {
    combined.remote_loads[i].force.setZero();
    for (int k = 0; k < 3; ++k) {
      combined.remote_loads[i].force += d[k] * unit[k].remote_loads[i].force;
    }
  }
  return combined;
}

VectorX combined(const std::vector<VectorX>& of_load_cases, int first,
                 const Vec3& d) {
  const auto unit = of_load_cases.begin() + first;
  return d[0] * unit[0] + d[1] * unit[1] + d[2] * unit[2];
}

std::string direction_text(const Vec3& direction) {
  constexpr double kNothing = 5e-4;  // below what three digits show
  const auto shown = [](double x) { return std::abs(x) < kNothing ? 0.0 : x; };
  return fmt::format("[{:.3g}, {:.3g}, {:.3g}]", shown(direction.x()),
                     shown(direction.y()), shown(direction.z()));
}

}  // namespace meniscus::responses
