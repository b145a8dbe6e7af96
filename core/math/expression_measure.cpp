#include <array>
#include <optional>

#include <fmt/format.h>

#include "core/math/expression_code.h"
#include "core/math/measure.h"

namespace meniscus {

namespace {

using namespace expression_code;
using Kind = Measure::Kind;

/// A number on the stack: its dimension, and its value where the text says it.
struct Measured {
  Measure measure;
  std::optional<double> value;
};

UnitPowers combined(const UnitPowers& a, const UnitPowers& b, double factor) {
  return {.length = a.length + factor * b.length,
          .force = a.force + factor * b.force,
          .time = a.time + factor * b.time};
}

bool is_function(int operation, std::string_view name) {
  return operation >= FirstFunction &&
         kFunctions[static_cast<std::size_t>(operation - FirstFunction)].name ==
             name;
}

Measure product(const Measure& a, const Measure& b, double sign) {
  if (a.kind == Kind::Unknown || b.kind == Kind::Unknown) {
    return {Kind::Unknown};
  }
  if (a.kind == Kind::Number && b.kind == Kind::Number) {
    return {Kind::Number};
  }
  return Measure::of(combined(a.powers, b.powers, sign));
}

/// Numbers have no powers, so that they are factors.
Measure raised(const Measure& a, double power) {
  return a.is_known() ? Measure::of(combined({}, a.powers, power)) : a;
}

/// One of them is where the text of an expression says so.
class Measurer {
 public:
  explicit Measurer(const std::string& text) : text_(text) {}

  /// What either of two values is that must be alike.
  Measure like(const Measure& a, const Measure& b, const char* what,
               int column) const {
    if (a.is_known() && b.is_known() && !(a.powers == b.powers)) {
      throw ExpressionError(
          fmt::format("{} of {} and {} in '{}'", what, described(a.powers),
                      described(b.powers), text_),
          column);
    }
    return a.is_known() || (a.kind == Kind::Unknown && !b.is_known()) ? a : b;
  }

  void require_number(const Measure& a, const char* what, int column) const {
    if (a.is_known() && !(a.powers == UnitPowers{})) {
      throw ExpressionError(
          fmt::format("{} of {} in '{}'", what, described(a.powers), text_),
          column);
    }
  }

  Measure power(const Measured* operands, int column) const {
    require_number(operands[1].measure, "the power", column);
    const Measure& base = operands[0].measure;
    if (!base.is_known() || base.powers == UnitPowers{}) {
      return base;
    }
    return operands[1].value ? raised(base, *operands[1].value)
                             : Measure{Kind::Unknown};
  }

  Measure applied(int operation, const Measured* operands, int column) const {
    const Measure& a = operands[0].measure;
    switch (operation) {
      case Negate:
        return a;
      case Add:
        return like(a, operands[1].measure, "the sum", column);
      case Subtract:
        return like(a, operands[1].measure, "the difference", column);
      case Multiply:
        return product(a, operands[1].measure, 1.0);
      case Divide:
        return product(a, operands[1].measure, -1.0);
      case Power:
        return power(operands, column);
      default:
        break;
    }
    if (operation < FirstFunction) {
      like(a, operands[1].measure, "the comparison", column);
      return {Kind::Number};
    }
    return of_function(operation, operands, column);
  }

 private:
  Measure of_function(int operation, const Measured* operands,
                      int column) const {
    constexpr double kRoot = 0.5;
    constexpr double kSquare = 2.0;
    const Measure& a = operands[0].measure;
    const char* name =
        kFunctions[static_cast<std::size_t>(operation - FirstFunction)].name;
    if (is_function(operation, "pow")) {
      return power(operands, column);
    }
    if (is_function(operation, "sqrt")) {
      return raised(a, kRoot);
    }
    if (is_function(operation, "sqr")) {
      return raised(a, kSquare);
    }
    if (is_function(operation, "abs")) {
      return a;
    }
    if (is_function(operation, "macaulay")) {
      const std::array<Measured, 2> both = {
          {{like(a, operands[2].measure, name, column), {}}, operands[1]}};
      return power(both.data(), column);
    }
    if (arity(operation) == 2) {
      const Measure both = like(a, operands[1].measure, name, column);
      return is_function(operation, "atan2") ? Measure{Kind::Number} : both;
    }
    require_number(a, name, column);
    return {Kind::Number};
  }

  const std::string& text_;
};

}  // namespace

Measure expression_code::measure_steps(const std::vector<Step>& code,
                                       const std::string& text,
                                       std::span<const Measure> names) {
  const Measurer measurer(text);
  std::vector<Measured> stack;
  std::vector<std::size_t> ends;  // of conditionals whose branches are open
  const auto close = [&](std::size_t at, int column) {
    for (; !ends.empty() && ends.back() == at; ends.pop_back()) {
      const Measure other = stack.back().measure;
      stack.pop_back();
      stack.back() = {
          measurer.like(stack.back().measure, other, "the branches", column),
          std::nullopt};
    }
  };
  for (std::size_t next = 0; next < code.size(); ++next) {
    const Step& at = code[next];
    close(next, at.column);
    if (at.operation == Number) {
      stack.push_back({{Kind::Number}, at.number});
    } else if (at.operation == Name) {
      stack.push_back({names[static_cast<std::size_t>(at.index)], {}});
    } else if (at.operation == Jump) {
      ends.push_back(static_cast<std::size_t>(at.index));
    } else if (at.operation == JumpIfZero) {
      stack.pop_back();
    } else {
      const auto count = static_cast<std::size_t>(arity(at.operation));
      const std::size_t rest = stack.size() - count;
      const Measured* operands = &stack[rest];
      Measured result{measurer.applied(at.operation, operands, at.column), {}};
      if (at.operation == Negate && operands[0].value) {
        result.value = -*operands[0].value;
      } else if (at.operation == Divide && operands[0].value &&
                 operands[1].value) {
        result.value = *operands[0].value / *operands[1].value;
      }
      stack.resize(rest);
      stack.push_back(result);
    }
  }
  close(code.size(), code.back().column);
  return stack.back().measure;
}

}  // namespace meniscus
