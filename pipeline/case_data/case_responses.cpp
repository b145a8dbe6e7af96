#include "pipeline/case_data/case_responses.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/expression.h"
#include "pipeline/case_data/response_kinds.h"

namespace meniscus::case_data {

namespace {

bool has_direction(ResponseKind kind) {
  const ResponseRow& row = row_of(kind);
  return needs_key(row, "direction") || needs_key(row, "axis");
}

/// `field` times `sign`; where it has no value, `what` and the place are told.
template <class Field>
Field told(const Field& field, double sign, const std::string& what) {
  return [field, sign, what](const Vec3& x) -> typename Field::result_type {
    try {
      return sign * field(x);
    } catch (const ExpressionError& error) {
      throw InvalidInput(
          fmt::format("{} has no value at ({:.4g}, {:.4g}, {:.4g}): {}; the "
                      "part's surface comes there, so make it one that has",
                      what, x.x(), x.y(), x.z(), error.what()));
    }
  };
}

}  // namespace

ResponseInputs response_of(const Case& input, const ResponseEntry& response,
                           const CaseValues& values) {
  const std::size_t before = values.problems().size();
  ResponseInputs result{.direction = values.at(response.direction)};
  if (response.point) {
    result.point = values.at(*response.point);
  }
  if (!values.are_rates() && has_direction(response.kind) &&
      values.problems().size() == before && !(result.direction.norm() > 0.0)) {
    const Quantity& first = response.direction[0];
    values.problems().push_back(fmt::format(
        "{}: {} has length 0{}; expected any other", place(input, first.line),
        first.key.substr(0, first.key.rfind('[')),
        values.where(response.direction)));
  }
  const auto what = [&](const PlaceQuantity& of) {
    return fmt::format("{}: {}", place(input, of.quantity.line),
                       of.quantity.key);
  };
  // Rates only of those that have one.
  const auto counts = [&](const PlaceQuantity& of) {
    return !values.are_rates() || values.moves(of.quantity);
  };
  if (const auto& weight = response.weight; weight && counts(*weight)) {
    result.weight = told(values.field(*weight), 1.0, what(*weight));
    result.weight_slope = told(values.slope(*weight), 1.0, what(*weight));
  }
  if (const auto& region = response.region; region && counts(*region)) {
    const double sign = response.side == RegionSide::KeepOut ? 1.0 : -1.0;
    result.level = told(values.field(*region), sign, what(*region));
    result.level_slope = told(values.slope(*region), sign, what(*region));
  }
  return result;
}

}  // namespace meniscus::case_data
