/// Dimensions of expressions.
#pragma once

#include <span>

#include "core/math/expression.h"
#include "core/units.h"

namespace meniscus {

/// What is known of the dimension behind a number: of a plain number in a text
/// nothing but that it stands for any in a sum, a comparison, min and max, and
/// is a factor elsewhere; of a name without a unit nothing at all.
struct Measure {
  enum class Kind { Number, Unknown, Known } kind = Kind::Unknown;
  UnitPowers powers = {};  // of Known
  static Measure of(const UnitPowers& powers) { return {Kind::Known, powers}; }
  bool is_known() const { return kind == Kind::Known; }
};

/// The dimension of the expression's value, from those of its names. Throws
/// ExpressionError where two that are known do not fit: 'a + b' of a force and
/// a length, the sine of a mass.
Measure measure_of(const Expression& expression,
                   std::span<const Measure> names);

}  // namespace meniscus
