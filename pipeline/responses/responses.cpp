#include "pipeline/responses/responses.h"

#include <algorithm>

#include <fmt/format.h>

#include "fea/functionals/displacement_functionals.h"
#include "fea/functionals/place_functionals.h"
#include "pipeline/case_data/composed_responses.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/case_data/response_kinds.h"
#include "pipeline/responses/response_partials.h"
#include "pipeline/responses/worst_loads.h"

namespace meniscus::responses {

functionals::ThicknessPairs thickness_pairs_of(const case_data::Case& input,
                                               const TetMesh& base) {
  const bool asked =
      std::any_of(input.responses.begin(), input.responses.end(),
                  [](const case_data::ResponseEntry& r) {
                    return r.kind == case_data::ResponseKind::Thickness;
                  });
  return asked ? functionals::thickness_pairs(base)
               : functionals::ThicknessPairs();
}

ResponsePartials partials_of(const case_data::ResponseEntry& response,
                             const case_data::ResponseInputs& inputs,
                             const ResponseContext& fields,
                             element::Derivatives derivatives) {
  if (case_data::is_composed(response)) {
    throw InvalidInput(
        fmt::format("response '{}' has no partial derivatives", response.name));
  }
  return compute_partials({response, inputs, fields, derivatives});
}

double place_rate(const case_data::ResponseEntry& response,
                  const case_data::ResponseInputs& inputs,
                  const case_data::ResponseInputs& rates,
                  const std::optional<Vec3>& worst_direction,
                  const ResponseContext& fields) {
  if (rates.weight) {
    const std::vector<VectorX>& all = fields.solution.displacements;
    const VectorX u = worst_direction
                          ? combined(all, response.load_case, *worst_direction)
                          : all[response.load_case];
    return functionals::weighted_displacement_functional(
               fields.mesh, response.surface, inputs.direction,
               {rates.weight, {}}, u, element::Derivatives::None)
        .value;
  }
  return rates.level ? functionals::intrusion_rate(
                           fields.mesh, inputs.level, rates.level,
                           sharpness_of(response, fields))
                     : 0.0;
}

VectorX respond_films(const case_data::Case& input,
                      const ResponseContext& fields, VectorX values) {
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    const case_data::ResponseEntry& response = input.responses[k];
    double& value = values[static_cast<Eigen::Index>(k)];
    if (case_data::is_composed(response)) {
      value = case_data::composed_value(input, response, fields.inputs.design,
                                        {values.data(), k});
    } else if (case_data::row_of(response.kind).of_films) {
      value = partials_of(response, fields.inputs.responses[k], fields,
                          element::Derivatives::None)
                  .value;
    }
  }
  return values;
}

VectorX respond(const case_data::Case& input, const ResponseContext& fields) {
  VectorX values(static_cast<Eigen::Index>(input.responses.size()));
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    const case_data::ResponseEntry& response = input.responses[k];
    values[static_cast<Eigen::Index>(k)] =
        case_data::is_composed(response)
            ? case_data::composed_value(input, response, fields.inputs.design,
                                        {values.data(), k})
            : partials_of(response, fields.inputs.responses[k], fields,
                          element::Derivatives::None)
                  .value;
  }
  return values;
}

}  // namespace meniscus::responses
