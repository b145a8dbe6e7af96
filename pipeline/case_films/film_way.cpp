#include "pipeline/case_films/film_way.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "pipeline/case_data/case_curves.h"
#include "pipeline/case_data/case_values.h"

namespace meniscus::case_films {

namespace {

/// Values at a design, of the parameters those that no design variable moves.
VectorX own_values(const case_data::Case& input, const VectorX& design) {
  std::vector<std::string> problems;
  const case_data::CaseValues values(input, design, problems);
  VectorX own(design.size() + std::ssize(input.parameters));
  own.head(design.size()) = design;
  Eigen::Index k = design.size();
  for (const case_data::Parameter& parameter : input.parameters) {
    own[k++] = values.follows_design(parameter.value)
                   ? std::numeric_limits<double>::quiet_NaN()
                   : values.at(parameter.value);
  }
  return own;
}

/// `input` with those parameters that have a value of their own there.
case_data::Case with_parameters(case_data::Case input, const VectorX& values,
                                const VectorX& own) {
  Eigen::Index k = std::ssize(input.design);
  for (case_data::Parameter& parameter : input.parameters) {
    if (std::isfinite(values[k]) && values[k] != own[k]) {
      parameter.value.expression = Expression(values[k]);
    }
    ++k;
  }
  fix_curves(input);
  return input;
}

Waypoint waypoint_at(const case_data::Case& input, VectorX values) {
  const VectorX design = values.head(std::ssize(input.design));
  const VectorX own = own_values(input, design);
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k]) || !std::isfinite(own[k])) {
      values[k] = own[k];
    }
  }
  films::FilmSystem system =
      evaluate(with_parameters(input, values, own), design).film_system;
  return {std::move(values), std::move(system)};
}

}  // namespace

std::vector<Waypoint> film_way(const case_data::Case& input,
                               const case_data::EvaluatedCase& inputs) {
  std::vector<Waypoint> way;
  try {
    for (const VectorX& values : input.way) {
      way.push_back(waypoint_at(input, values));
    }
  } catch (const InvalidInput& error) {
    throw InvalidInput(
        fmt::format("{} (at the values of 'start')", error.what()));
  }
  for (const VectorX& design : input.earlier_freezes) {
    way.push_back(
        {own_values(input, design), evaluate(input, design).film_system});
  }
  way.push_back({own_values(input, inputs.design), inputs.film_system});
  return way;
}

Waypoint waypoint_between(const case_data::Case& input, const Waypoint& a,
                          const Waypoint& b) {
  return waypoint_at(input, 0.5 * (a.values + b.values));
}

}  // namespace meniscus::case_films
