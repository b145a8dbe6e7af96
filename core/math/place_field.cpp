#include "core/math/place_field.h"

#include <array>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/bound_text.h"

namespace meniscus {

namespace {

[[noreturn]] void fail_at(const ExpressionError& error, const Vec3& at) {
  throw ExpressionError(fmt::format("{} at ({:.5g}, {:.5g}, {:.5g})",
                                    error.what(), at.x(), at.y(), at.z()),
                        error.column());
}

void check_positive(const PlaceField& field, double value) {
  if (field.positive && !(value > 0.0)) {
    const std::string& text =
        field.text.empty() ? field.formula.text() : field.text;
    throw ExpressionError(
        fmt::format("'{}' is {:.6g}; it must be above 0", text, value), 1);
  }
}

PlaceJet jet_of(const Dual3& dual) {
  return {dual.value, dual.gradient, dual.hessian};
}

/// Calls each(shape, its coefficients' first) for shape after shape.
template <class Each>
void over_shapes(const PlaceField& field, const Each& each) {
  std::size_t first = field.names.size();
  for (const auto& shape : field.shapes) {
    each(*shape, first);
    first += static_cast<std::size_t>(shape->coefficients());
  }
}

Numbers part(Numbers numbers, const PlaceShape& shape, std::size_t first) {
  return numbers.subspan(first, static_cast<std::size_t>(shape.coefficients()));
}

}  // namespace

double value_at(const Expression& expression, const Vec3& at) {
  try {
    return expression.evaluate(std::span<const double>(at.data(), 3));
  } catch (const ExpressionError& error) {
    fail_at(error, at);
  }
}

PlaceJet jet_at(const Expression& expression, const Vec3& at) {
  if (expression.is_constant()) {
    return {.value = value_at(expression, at)};
  }
  const std::array<Dual3, 3> values = {Dual3::variable(at.x(), 0),
                                       Dual3::variable(at.y(), 1),
                                       Dual3::variable(at.z(), 2)};
  try {
    return jet_of(expression.evaluate(std::span<const Dual3>(values)));
  } catch (const ExpressionError& error) {
    fail_at(error, at);
  }
}

bool is_same_but_numbers(const PlaceField& a, const PlaceField& b) {
  return a.formula.text() == b.formula.text() && a.names == b.names &&
         a.shapes == b.shapes && a.numbers.size() == b.numbers.size();
}

double value_at(const PlaceField& field, Numbers numbers, const Vec3& at) {
  static thread_local std::vector<double> values;
  values.assign(at.begin(), at.end());
  values.insert(values.end(), numbers.begin(),
                numbers.begin() + std::ssize(field.names));
  try {
    over_shapes(field, [&](const PlaceShape& shape, std::size_t first) {
      values.push_back(shape.jet(at, part(numbers, shape, first)).value);
    });
    const double value = field.formula.evaluate(values);
    check_positive(field, value);
    return value;
  } catch (const ExpressionError& error) {
    fail_at(error, at);
  }
}

PlaceJet jet_at(const PlaceField& field, Numbers numbers, const Vec3& at) {
  if (field.is_constant()) {
    return {.value = value_at(field, numbers, at)};
  }
  static thread_local std::vector<Dual3> values;
  values.clear();
  for (int m = 0; m < 3; ++m) {
    values.push_back(Dual3::variable(at[m], m));
  }
  values.insert(values.end(), numbers.begin(),
                numbers.begin() + std::ssize(field.names));
  try {
    over_shapes(field, [&](const PlaceShape& shape, std::size_t first) {
      const PlaceJet own = shape.jet(at, part(numbers, shape, first));
      Dual3 value(own.value);
      value.varies = true;
      value.gradient = own.gradient;
      value.hessian = own.hessian;
      values.push_back(value);
    });
    const Dual3 dual = field.formula.evaluate(std::span<const Dual3>(values));
    check_positive(field, dual.value);
    return jet_of(dual);
  } catch (const ExpressionError& error) {
    fail_at(error, at);
  }
}

namespace {

/// What an expression's values are at a place, how fast they change, and
/// derivatives by both.
struct Sweep {
  std::vector<double> values, rates, by_values, by_rates;

  Sweep(const PlaceField& field, Numbers numbers, const Vec3& at)
      : values(at.begin(), at.end()), rates(3, 0.0) {
    values.insert(values.end(), numbers.begin(),
                  numbers.begin() + std::ssize(field.names));
  }
  Expression::Rate run(const Expression& formula, double by_value,
                       double by_rate) {
    by_values.assign(values.size(), 0.0);
    by_rates.assign(values.size(), 0.0);
    return formula.transpose(values, rates, by_value, by_rate, by_values,
                             by_rates);
  }
};

}  // namespace

PlaceJet rate_at(const PlaceField& field, Numbers numbers, Numbers rates,
                 const Vec3& at) {
  Sweep sweep(field, numbers, at);
  sweep.rates.insert(sweep.rates.end(), rates.begin(),
                     rates.begin() + std::ssize(field.names));
  std::vector<Vec3> gradients;  // of the shapes and of their rates
  over_shapes(field, [&](const PlaceShape& shape, std::size_t first) {
    const PlaceJet own = shape.jet(at, part(numbers, shape, first));
    const PlaceJet rate = shape.jet(at, part(rates, shape, first));
    sweep.values.push_back(own.value);
    sweep.rates.push_back(rate.value);
    gradients.push_back(own.gradient);
    gradients.push_back(rate.gradient);
  });
  PlaceJet jet;
  try {
    jet.value = sweep.run(field.formula, 0.0, 1.0).rate;
  } catch (const ExpressionError& error) {
    fail_at(error, at);
  }
  jet.gradient =
      Vec3(sweep.by_values[0], sweep.by_values[1], sweep.by_values[2]);
  const std::size_t first = 3 + field.names.size();
  for (std::size_t s = 0; s < field.shapes.size(); ++s) {
    jet.gradient += sweep.by_values[first + s] * gradients[2 * s] +
                    sweep.by_rates[first + s] * gradients[2 * s + 1];
  }
  return jet;
}

void add_by_numbers(const PlaceField& field, Numbers numbers, const Vec3& at,
                    double by_value, const Vec3& by_gradient, VectorX& sum) {
  Sweep sweep(field, numbers, at);
  for (int m = 0; m < 3; ++m) {
    sweep.rates[m] = by_gradient[m];
  }
  sweep.rates.resize(sweep.values.size(), 0.0);
  over_shapes(field, [&](const PlaceShape& shape, std::size_t first) {
    const PlaceJet own = shape.jet(at, part(numbers, shape, first));
    sweep.values.push_back(own.value);
    sweep.rates.push_back(own.gradient.dot(by_gradient));
  });
  try {
    sweep.run(field.formula, by_value, 1.0);
  } catch (const ExpressionError& error) {
    fail_at(error, at);
  }
  for (std::size_t k = 0; k < field.names.size(); ++k) {
    sum[static_cast<Eigen::Index>(k)] += sweep.by_values[3 + k];
  }
  std::size_t slot = 3 + field.names.size();
  over_shapes(field, [&](const PlaceShape& shape, std::size_t first) {
    shape.add_transposed(
        at, sweep.by_values[slot], sweep.by_rates[slot] * by_gradient,
        std::span<double>(sum.data() + first,
                          static_cast<std::size_t>(shape.coefficients())));
    ++slot;
  });
}

Expression with_numbers(const PlaceField& field) {
  if (!field.shapes.empty()) {
    throw InvalidInput(fmt::format(
        "'{}' has shapes of fields, which no expression of x, y, z has",
        field.formula.text()));
  }
  if (!field.has_numbers()) {
    return field.formula;
  }
  return Expression::parse(
      with_values(field.formula.text(), field.names,
                  Numbers(field.numbers.data(), field.names.size())),
      {"x", "y", "z"});
}

}  // namespace meniscus
