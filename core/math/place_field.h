/// Numbers that vary from place to place: expressions over x, y, z, and fields
/// whose names and shapes follow a design.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/math/expression.h"
#include "core/math/place_shape.h"
#include "core/types.h"

namespace meniscus {

/// Of a field, those that follow the design.
using Numbers = std::span<const double>;

/// Of an expression over x, y, z. Both throw ExpressionError, naming the place,
/// where it has no value.
double value_at(const Expression& expression, const Vec3& at);
PlaceJet jet_at(const Expression& expression, const Vec3& at);

/// A formula over x, y, z, then names, then the values of shapes there.
struct PlaceField {
  Expression formula;
  std::vector<std::string> names;  // of the design, as the formula has them
  std::vector<std::shared_ptr<const PlaceShape>> shapes;
  /// The names' values, then the coefficients of each shape; or the rates of
  /// these. Fields of one design differ from another's in these alone.
  VectorX numbers;
  bool positive = false;  // no value where it is not above 0
  std::string text;       // for messages; empty: the formula's

  PlaceField() = default;
  /// Of x, y, z alone.
  PlaceField(Expression of_place)  // NOLINT: expressions are fields
      : formula(std::move(of_place)) {}

  bool has_numbers() const { return numbers.size() > 0; }
  Numbers own() const {
    return {numbers.data(), static_cast<std::size_t>(numbers.size())};
  }
  bool is_constant() const { return formula.is_constant(); }
};

/// Do they differ in their numbers alone?
bool is_same_but_numbers(const PlaceField& a, const PlaceField& b);

/// All throw ExpressionError, naming the place, where the field has no value.
/// `numbers`: as of the field, at another design.
double value_at(const PlaceField& field, Numbers numbers, const Vec3& at);
PlaceJet jet_at(const PlaceField& field, Numbers numbers, const Vec3& at);
/// How fast value and gradient change as the numbers do.
PlaceJet rate_at(const PlaceField& field, Numbers numbers, Numbers rates,
                 const Vec3& at);
/// Adds to `sum`, one per number, by_value x the derivative of the value and
/// by_gradient . that of the gradient. The cost does not grow with the number
/// of coefficients.
void add_by_numbers(const PlaceField& field, Numbers numbers, const Vec3& at,
                    double by_value, const Vec3& by_gradient, VectorX& sum);

/// The field at its numbers as an expression over x, y, z. Throws InvalidInput
/// for one with shapes.
Expression with_numbers(const PlaceField& field);

}  // namespace meniscus
