#include "pipeline/forward/responses.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "fea/functionals/displacement_functionals.h"
#include "fea/functionals/place_functionals.h"
#include "fea/loads/body_loads.h"
#include "pipeline/case_data/case_values.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/response_partials.h"

namespace meniscus {

namespace {

/// Over the case's names and the values above.
double expression_value(const Case& input, const ResponseEntry& response,
                        const VectorX& design, std::span<const double> above) {
  std::vector<std::string> problems;
  const double value =
      CaseValues(input, design, problems).at(response.value, above);
  if (!problems.empty()) {
    throw InvalidInput(problems.front());
  }
  return value;
}

}  // namespace

StressField load_case_stress(const TetMesh& mesh, const EvaluatedCase& numbers,
                             std::size_t load_case, const VectorX& u,
                             const std::vector<char>& excluded) {
  StressField field =
      recover_stress(mesh, numbers.materials, u,
                     temperature_change(mesh, numbers.load_cases[load_case]));
  if (!excluded.empty()) {
    find_peak(mesh, excluded, field);
  }
  return field;
}

ThicknessPairs thickness_pairs_of(const Case& input, const TetMesh& base) {
  const bool asked = std::any_of(
      input.responses.begin(), input.responses.end(),
      [](const ResponseEntry& r) { return r.kind == ResponseKind::Thickness; });
  return asked ? thickness_pairs(base) : ThicknessPairs();
}

ResponsePartials partials_of(const ResponseEntry& response,
                             const ResponseNumbers& numbers,
                             const ResponseInput& fields,
                             Derivatives derivatives) {
  if (response.kind == ResponseKind::Expression) {
    throw InvalidInput(
        fmt::format("response '{}' has no partial derivatives", response.name));
  }
  return compute_partials({response, numbers, fields, derivatives});
}

double place_rate(const ResponseEntry& response, const ResponseNumbers& numbers,
                  const ResponseNumbers& rates, const ResponseInput& fields) {
  if (rates.weight) {
    return weighted_displacement_functional(
               fields.mesh, response.surface, numbers.direction,
               {rates.weight, {}},
               fields.solution.displacements[response.load_case],
               Derivatives::None)
        .value;
  }
  return rates.level ? intrusion_rate(fields.mesh, numbers.level, rates.level,
                                      sharpness_of(response, fields))
                     : 0.0;
}

VectorX respond(const Case& input, const ResponseInput& fields) {
  VectorX values(static_cast<Eigen::Index>(input.responses.size()));
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    const ResponseEntry& response = input.responses[k];
    values[static_cast<Eigen::Index>(k)] =
        response.kind == ResponseKind::Expression
            ? expression_value(input, response, fields.numbers.design,
                               {values.data(), k})
            : partials_of(response, fields.numbers.responses[k], fields,
                          Derivatives::None)
                  .value;
  }
  return values;
}

}  // namespace meniscus
