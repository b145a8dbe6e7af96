#include "core/math/expression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/math/expression_code.h"
#include "core/math/macaulay.h"
#include "core/math/taped.h"

namespace meniscus {

namespace {

using namespace expression_code;

// In the order of Operation, from Negate on.
constexpr std::array<const char*, FirstFunction - Negate> kSymbols = {
    "-", "+", "-", "*", "/", "^", "<", "<=", ">", ">=", "==", "!="};

double value_of(double x) { return x; }
template <class Number>
double value_of(const Number& x) {
  return x.value;
}

bool is_finite(double x) { return std::isfinite(x); }
template <int N>
bool is_finite(const BasicDual<N>& x) {
  return std::isfinite(x.value) &&
         (x.is_constant() || (x.gradient.allFinite() && x.hessian.allFinite()));
}

bool is_finite(const Taped& x) {
  return std::isfinite(x.value) && std::isfinite(x.rate);
}

template <class Scalar>
Scalar apply_operator(int operation, const Scalar* a) {
  using std::pow;
  if (operation == Negate) {
    return -a[0];
  }
  const double x = value_of(a[0]);
  const double y = value_of(a[1]);
  switch (operation) {
    case Add:
      return a[0] + a[1];
    case Subtract:
      return a[0] - a[1];
    case Multiply:
      return a[0] * a[1];
    case Divide:
      return a[0] / a[1];
    case Power:
      return pow(a[0], a[1]);
    case Less:
      return x < y ? 1.0 : 0.0;
    case LessEqual:
      return x <= y ? 1.0 : 0.0;
    case Greater:
      return x > y ? 1.0 : 0.0;
    case GreaterEqual:
      return x >= y ? 1.0 : 0.0;
    case Equal:
      return x == y ? 1.0 : 0.0;
    default:
      return x != y ? 1.0 : 0.0;
  }
}

// In the order of kFunctions.
template <class Scalar>
Scalar apply_function(int function, const Scalar* a) {
  using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos,
      std::cosh, std::exp, std::log, std::pow, std::sin, std::sinh, std::sqrt,
      std::tan, std::tanh;
  switch (function) {
    case 0:
      return sin(a[0]);
    case 1:
      return cos(a[0]);
    case 2:
      return tan(a[0]);
    case 3:
      return asin(a[0]);
    case 4:
      return acos(a[0]);
    case 5:
      return atan(a[0]);
    case 6:
      return sinh(a[0]);
    case 7:
      return cosh(a[0]);
    case 8:
      return tanh(a[0]);
    case 9:
      return exp(a[0]);
    case 10:
      return log(a[0]);
    case 11:
      return log(a[0]) * Scalar(std::numbers::log10e);
    case 12:
      return sqrt(a[0]);
    case 13:
      return abs(a[0]);
    case 14:
      return a[0] * a[0];
    case 15:
      return atan2(a[0], a[1]);
    case 16:
      return value_of(a[1]) < value_of(a[0]) ? a[1] : a[0];
    case 17:
      return value_of(a[1]) > value_of(a[0]) ? a[1] : a[0];
    case 18:
      return pow(a[0], a[1]);
    default:
      return macaulay(a[0], a[1], a[2]);
  }
}

// "sqrt(-1)", "1e+200 * 1e+200"
std::string application(int operation, const std::vector<double>& operands) {
  if (operation >= FirstFunction) {
    return fmt::format(
        "{}({:g})",
        kFunctions[static_cast<std::size_t>(operation - FirstFunction)].name,
        fmt::join(operands, ", "));
  }
  const char* symbol = kSymbols[static_cast<std::size_t>(operation - Negate)];
  return operation == Negate
             ? fmt::format("-{:g}", operands[0])
             : fmt::format("{:g} {} {:g}", operands[0], symbol, operands[1]);
}

[[noreturn]] void not_finite(int operation, const std::vector<double>& operands,
                             double value, const std::string& text,
                             int column) {
  const std::string what =
      operation == Divide && operands[1] == 0.0
          ? fmt::format("division of {:g} by zero", operands[0])
          : fmt::format("{} {}", application(operation, operands),
                        std::isfinite(value) ? "has no finite derivative"
                                             : "is not a finite number");
  throw ExpressionError(fmt::format("{} in '{}'", what, text), column);
}

[[noreturn]] void bad_value(double value, const std::string& text, int column) {
  const auto first = static_cast<std::size_t>(column) - 1;
  std::size_t end = text.find_first_not_of(
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_", first);
  if (end != std::string::npos && text[end] == '[') {
    end = text.find(']', end) + 1;
  }
  throw ExpressionError(
      fmt::format("'{}' is {}, not a finite number, in '{}'",
                  text.substr(first, end - first), value, text),
      column);
}

}  // namespace

Expression::Expression(double constant) : text_(fmt::format("{}", constant)) {
  code_.push_back({.operation = Number, .number = constant, .column = 1});
}

template <class Scalar>
Scalar Expression::run(std::span<const Scalar> values) const {
  static thread_local std::vector<Scalar> stack;  // no allocation per call
  stack.clear();
  for (std::size_t next = 0; next < code_.size();) {
    const Instruction& at = code_[next++];
    if (at.operation == Number) {
      stack.emplace_back(at.number);
    } else if (at.operation == Name) {
      stack.push_back(values[static_cast<std::size_t>(at.index)]);
      if (!std::isfinite(value_of(stack.back()))) {
        bad_value(value_of(stack.back()), text_, at.column);
      }
    } else if (at.operation == Jump) {
      next = static_cast<std::size_t>(at.index);
    } else if (at.operation == JumpIfZero) {
      next = value_of(stack.back()) == 0.0 ? static_cast<std::size_t>(at.index)
                                           : next;
      stack.pop_back();
    } else {
      const auto count = static_cast<std::size_t>(arity(at.operation));
      const std::size_t rest = stack.size() - count;
      const Scalar* operands = &stack[rest];
      Scalar result =
          at.operation < FirstFunction
              ? apply_operator(at.operation, operands)
              : apply_function(at.operation - FirstFunction, operands);
      if (!is_finite(result)) {
        std::vector<double> numbers;
        for (std::size_t k = rest; k < stack.size(); ++k) {
          numbers.push_back(value_of(stack[k]));
        }
        not_finite(at.operation, numbers, value_of(result), text_, at.column);
      }
      stack.resize(rest);
      stack.push_back(std::move(result));
    }
  }
  return stack.back();
}

double Expression::evaluate(std::span<const double> values) const {
  return run(values);
}

Dual Expression::evaluate(std::span<const Dual> values) const {
  return run(values);
}

Dual3 Expression::evaluate(std::span<const Dual3> values) const {
  return run(values);
}

Expression::Rate Expression::transpose(std::span<const double> values,
                                       std::span<const double> rates,
                                       double by_value, double by_rate,
                                       std::span<double> by_values,
                                       std::span<double> by_rates) const {
  static thread_local Tape tape;
  static thread_local std::vector<Taped> inputs;
  tape.clear();
  inputs.clear();
  for (std::size_t k = 0; k < values.size(); ++k) {
    inputs.push_back(tape.input(values[k], rates[k]));
  }
  const Taped result = run(std::span<const Taped>(inputs));
  tape.transpose(result, by_value, by_rate, by_values, by_rates);
  return {result.value, result.rate};
}

int Expression::bare_name() const {
  return code_.size() == 1 && code_[0].operation == Name ? code_[0].index : -1;
}

bool Expression::is_constant() const {
  return std::none_of(code_.begin(), code_.end(), [](const Instruction& at) {
    return at.operation == Name;
  });
}

std::vector<int> Expression::names_used() const {
  std::set<int> used;
  for (const Instruction& at : code_) {
    if (at.operation == Name) {
      used.insert(at.index);
    }
  }
  return {used.begin(), used.end()};
}

bool is_reserved_name(std::string_view name) {
  const auto is = [&](const auto& entry) { return name == entry.name; };
  return std::any_of(kConstants.begin(), kConstants.end(), is) ||
         std::any_of(kFunctions.begin(), kFunctions.end(), is) ||
         name == kConditional || name == "x" || name == "y" || name == "z";
}

std::string element_name(std::string_view vector,
                         std::span<const int> indices) {
  return fmt::format("{}[{}]", vector, fmt::join(indices, ","));
}

std::string shape_text(std::span<const int> shape) {
  return fmt::format("{}", fmt::join(shape, " x "));
}

}  // namespace meniscus
