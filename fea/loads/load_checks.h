/// Messages about loads that name the load case and the place (internal).
#pragma once

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/expression.h"
#include "fea/loads/load_case.h"

namespace meniscus::loads {

inline bool is_finite(double value) { return std::isfinite(value); }
inline bool is_finite(const Vec3& value) { return value.allFinite(); }
inline bool is_finite(const Mat3& value) { return value.allFinite(); }

/// Throws InvalidInput for a number or vector that is not finite. `what`:
/// "the pressure on surface 'lid'".
template <class Value>
void require_finite(const Value& value, const LoadCase& load_case,
                    const std::string& what) {
  if (!is_finite(value)) {
    throw InvalidInput(fmt::format("load case '{}': {} is not a finite number",
                                   load_case.name, what));
  }
}

/// The field's value at x. Throws InvalidInput where it has no finite one.
template <class Field>
auto field_value(const Field& field, const Vec3& x, const LoadCase& load_case,
                 const std::string& what) {
  const auto refuse = [&](const std::string& why) {
    throw InvalidInput(
        fmt::format("load case '{}': {} at ({:.4g}, {:.4g}, {:.4g}) {}",
                    load_case.name, what, x.x(), x.y(), x.z(), why));
  };
  try {
    const auto value = field(x);
    if (!is_finite(value)) {
      refuse("is not a finite number");
    }
    return value;
  } catch (const ExpressionError& error) {
    refuse(fmt::format("has no value: {}", error.what()));
    throw;
  }
}

/// Throws InvalidInput where derivatives need a field's gradient that was not
/// given.
template <class Field>
void require_slope(const Field& slope, const LoadCase& load_case,
                   const std::string& what) {
  if (!slope) {
    throw InvalidInput(fmt::format(
        "load case '{}': {} is a field without a slope; derivatives by the "
        "shape need its gradient",
        load_case.name, what));
  }
}

}  // namespace meniscus::loads
