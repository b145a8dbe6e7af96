#include "pipeline/case_data/case_values.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/bound_text.h"

namespace meniscus::case_data {

namespace {

/// The name itself, or of an element "t[2,3]" another, unlike all of the case
/// and all of `taken`: no index of it is to be checked again.
std::string plain_name(const Case& input, const std::string& name,
                       const std::vector<std::string>& taken) {
  if (name.find('[') == std::string::npos) {
    return name;
  }
  std::string plain = fmt::format("n{}", taken.size());
  const auto is_plain = [&](const auto& entry) { return entry.name == plain; };
  const auto has_plain = [&](const auto& entries) {
    return std::any_of(entries.begin(), entries.end(), is_plain);
  };
  while (has_plain(input.design) || has_plain(input.parameters) ||
         has_plain(input.shapes) ||
         std::find(taken.begin(), taken.end(), plain) != taken.end()) {
    plain += '_';
  }
  return plain;
}

double rate_of(const Dual& value) {
  return value.is_constant() ? 0.0 : value.gradient[0];
}

}  // namespace

CaseValues::CaseValues(const Case& input, const VectorX& design,
                       std::vector<std::string>& problems)
    : input_(input), problems_(problems) {
  if (design.size() != static_cast<Eigen::Index>(input.design.size())) {
    throw InvalidInput(fmt::format("{}: {} design values for {} variables",
                                   input.path, design.size(),
                                   input.design.size()));
  }
  values_.assign(design.begin(), design.end());
  values_.resize(input.design.size() + input.parameters.size(), 0.0);
  parameter_follows_.resize(input.parameters.size(), 0);
  for (const int k : input.parameter_order) {
    const auto i = static_cast<std::size_t>(k);
    values_[input.design.size() + i] = at(input.parameters[i].value);
    parameter_follows_[i] = follows_design(input.parameters[i].value) ? 1 : 0;
  }
}

const std::string& CaseValues::name_of(std::size_t k) const {
  const std::size_t design = input_.design.size();
  return k < design ? input_.design[k].name
                    : input_.parameters[k - design].name;
}

std::vector<std::string> CaseValues::names() const {
  std::vector<std::string> result;
  for (std::size_t k = 0; k < values_.size(); ++k) {
    result.push_back(name_of(k));
  }
  return result;
}

bool CaseValues::follows(int name) const {
  const auto k = static_cast<std::size_t>(name);
  const std::size_t design = input_.design.size();
  return k < design || (k < values_.size() && parameter_follows_[k - design]);
}

bool CaseValues::follows_design(const Quantity& quantity) const {
  const std::vector<int> used = quantity.expression.names_used();
  return std::any_of(used.begin(), used.end(),
                     [this](int name) { return follows(name); });
}

CaseValues::CaseValues(const Case& input, const VectorX& design,
                       std::vector<std::string>& problems, int rate_by)
    : CaseValues(input, design, problems) {
  std::vector<Dual> duals(values_.begin(), values_.end());
  duals[static_cast<std::size_t>(rate_by)] =
      Dual::variable(design[rate_by], 0, 1);
  for (const int k : input.parameter_order) {
    const auto i = static_cast<std::size_t>(k);
    duals[input.design.size() + i] =
        input.parameters[i].value.expression.evaluate(duals);
  }
  duals_ = std::move(duals);
}

double CaseValues::evaluate(const Quantity& quantity) const {
  if (!are_rates()) {
    return quantity.expression.evaluate(values_);
  }
  // Coefficients are names of their own, as many as variables.
  if (const int name = quantity.expression.bare_name(); name >= 0) {
    return rate_of(duals_[static_cast<std::size_t>(name)]);
  }
  return rate_of(quantity.expression.evaluate(duals_));
}

double CaseValues::at(const Quantity& quantity) const {
  try {
    return evaluate(quantity);
  } catch (const ExpressionError& error) {
    nothing(quantity, error);
    return 0.0;
  }
}

Dual1 CaseValues::dual(const Quantity& quantity) const {
  if (!are_rates()) {
    return {at(quantity)};
  }
  Dual1 result(quantity.expression.evaluate(values_));
  const double rate = at(quantity);
  if (rate != 0.0) {
    result.varies = true;
    result.gradient[0] = rate;
  }
  return result;
}

Expression CaseValues::of_place(const PlaceQuantity& place_quantity) const {
  const Quantity& quantity = place_quantity.quantity;
  if (!place_quantity.of_place) {
    return Expression(at(quantity));
  }
  try {
    return Expression::parse(
        with_values(quantity.expression.text(), names(), values_),
        {"x", "y", "z"});
  } catch (const ExpressionError& error) {
    problems_.push_back(fmt::format("{}: {}: {}", place(input_, quantity.line),
                                    quantity.key, error.what()));
    return Expression();
  }
}

PlaceField CaseValues::place_field(const PlaceQuantity& place_quantity) const {
  const Expression& from = place_quantity.quantity.expression;
  std::vector<std::string> before;  // names in its text, and what takes
  std::vector<std::string> after;   // their places
  PlaceField result;
  result.text = from.text();
  std::vector<double> numbers;
  std::vector<double> coefficients;
  std::vector<std::string> shapes;
  const std::size_t first_shape = values_.size() + 3;
  for (const int name : from.names_used()) {
    const auto k = static_cast<std::size_t>(name);
    if (k >= first_shape) {
      const ShapeEntry& entry = input_.shapes[k - first_shape];
      result.shapes.push_back(entry.shape);
      shapes.push_back(entry.name);
      for (const Quantity& coefficient : entry.coefficients) {
        coefficients.push_back(at(coefficient));
      }
    } else if (follows(name)) {
      before.push_back(name_of(k));
      after.push_back(plain_name(input_, name_of(k), after));
      result.names.push_back(after.back());
      numbers.push_back(are_rates() ? rate_of(duals_[k]) : values_[k]);
    } else if (k < values_.size()) {
      before.push_back(name_of(k));
      after.push_back(fmt::format("({})", values_[k]));
    }
  }
  numbers.insert(numbers.end(), coefficients.begin(), coefficients.end());
  result.numbers =
      Eigen::Map<const VectorX>(numbers.data(), std::ssize(numbers));
  if (are_rates()) {
    return result;  // of these only the numbers differ
  }
  std::vector<std::string> all = {"x", "y", "z"};
  all.insert(all.end(), result.names.begin(), result.names.end());
  all.insert(all.end(), shapes.begin(), shapes.end());
  try {
    result.formula =
        Expression::parse(with_texts(from.text(), before, after), all);
  } catch (const ExpressionError& error) {
    problems_.push_back(fmt::format("{}: {}: {}",
                                    place(input_, place_quantity.quantity.line),
                                    place_quantity.quantity.key, error.what()));
  }
  return result;
}

loads::NumberOfPlace CaseValues::field(
    const PlaceQuantity& place_quantity) const {
  if (!are_rates()) {
    return [expression = of_place(place_quantity)](const Vec3& x) {
      return expression.evaluate(std::span<const double>(x.data(), 3));
    };
  }
  return [expression = place_quantity.quantity.expression,
          names = duals_](const Vec3& x) {
    std::vector<Dual> values = names;
    values.insert(values.end(), x.begin(), x.end());
    return rate_of(expression.evaluate(values));
  };
}

loads::VectorOfPlace CaseValues::slope(
    const PlaceQuantity& place_quantity) const {
  return [expression = of_place(place_quantity)](const Vec3& x) -> Vec3 {
    const std::array<Dual3, 3> at = {Dual3::variable(x.x(), 0),
                                     Dual3::variable(x.y(), 1),
                                     Dual3::variable(x.z(), 2)};
    return expression.evaluate(std::span<const Dual3>(at)).gradient;
  };
}

bool CaseValues::moves(const Quantity& quantity) const {
  const std::vector<int> used = quantity.expression.names_used();
  return std::any_of(used.begin(), used.end(), [this](int name) {
    const auto k = static_cast<std::size_t>(name);
    return k < duals_.size() && rate_of(duals_[k]) != 0.0;
  });
}

double CaseValues::nothing(const Quantity& quantity,
                           const ExpressionError& error) const {
  problems_.push_back(fmt::format("{}: {}: {}{}", place(input_, quantity.line),
                                  quantity.key, error.what(), where(quantity)));
  return std::numeric_limits<double>::quiet_NaN();
}

double CaseValues::at(const Quantity& quantity,
                      std::span<const double> more) const {
  std::vector<double> values = values_;
  values.insert(values.end(), more.begin(), more.end());
  try {
    return quantity.expression.evaluate(values);
  } catch (const ExpressionError& error) {
    return nothing(quantity, error);
  }
}

double CaseValues::rate(const Quantity& quantity, std::span<const double> more,
                        std::span<const double> more_rates) const {
  std::vector<Dual> values = duals_;
  for (std::size_t k = 0; k < more.size(); ++k) {
    Dual value = Dual::variable(more[k], 0, 1);
    value.gradient[0] = more_rates[k];
    values.push_back(value);
  }
  try {
    return rate_of(quantity.expression.evaluate(values));
  } catch (const ExpressionError& error) {
    return nothing(quantity, error);
  }
}

void CaseValues::add_problem(const Quantity& quantity, double value,
                             const char* must_be) const {
  problems_.push_back(fmt::format("{}: {} is {:g}{}; it must be {}",
                                  place(input_, quantity.line), quantity.key,
                                  value, where(quantity), must_be));
}

std::string CaseValues::where_text(const std::vector<char>& used) const {
  constexpr std::ptrdiff_t kMost = 8;  // more are a table, not a hint
  if (std::count(used.begin(), used.end(), 1) > kMost) {
    return {};
  }
  std::string text;
  for (std::size_t k = 0; k < used.size(); ++k) {
    if (used[k] != 0) {
      text += fmt::format("{}{} = {:g}", text.empty() ? " where " : ", ",
                          name_of(k), values_[k]);
    }
  }
  return text;
}

void CaseValues::mark(const Quantity& quantity, std::vector<char>& used) {
  for (const int name : quantity.expression.names_used()) {
    if (static_cast<std::size_t>(name) < used.size()) {  // else x, y or z
      used[static_cast<std::size_t>(name)] = 1;
    }
  }
}

}  // namespace meniscus::case_data
