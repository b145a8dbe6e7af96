/// Arithmetic expressions over named values, as they stand in case files.
/// Evaluated over numbers or over duals, so first and second derivatives are
/// exact (docs/decisions/0001-expressions.md).
///
///   + - * / ^ (right associative)   comparisons < <= > >= == !=
///   sin cos tan asin acos atan atan2 sinh cosh tanh exp log log10 sqrt abs
///   min max pow sqr if(condition, then, else) macaulay(s, n, w)
///   pi  e  deg (= pi / 180; angles are radians)
///   t[2, i + 1]: an element of a vector, its indices constant, from 1
///
/// -2^2 is -4; 2^-1 is 0.5. A comparison is 1 or 0. Of if() only the branch
/// that holds is evaluated. abs, min, max, if and comparisons are not smooth
/// where they switch; derivatives there are those of the side taken (abs at 0:
/// of the right side).
///
/// macaulay(s, n, w) is the bracket <s>^n, n >= 0, rounded over the width w:
/// ((s + sqrt(s^2 + w^2)) / 2)^n, and for n = 0 the slope of that of n = 1,
/// (1 + s / sqrt(s^2 + w^2)) / 2. With w = 0 it has its corner: max(s, 0)^n,
/// and a switch that is 1 at s = 0.
#pragma once

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/dual.h"
#include "core/nearest_name.h"

namespace meniscus {

/// What is wrong with an expression: message and column (from 1) in its text.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(const std::string& message, int column)
      : std::runtime_error(message), column_(column) {}
  int column() const { return column_; }

 private:
  int column_;
};

/// Compiled once, evaluated often; a value, safe to use from several threads.
class Expression {
 public:
  /// The number 0.
  Expression() : Expression(0.0) {}
  explicit Expression(double constant);

  /// `names`: the values that may appear, by position. Those of a vector are
  /// the names of its elements (element_name), the last of them that of the
  /// largest indices. `constants`: per name, its value where an index may use
  /// it; none without. Throws ExpressionError: syntax, unknown name (with the
  /// nearest known one), a vector without indices, an index beyond its vector
  /// or not whole or not constant, more than 200 levels of nesting, longer than
  /// 10,000 characters. The decimal sign is a point whatever the locale.
  static Expression parse(
      std::string_view text, const std::vector<std::string>& names,
      std::span<const std::optional<double>> constants = {});

  /// `values`: one per name given to parse(). Throws ExpressionError, naming
  /// operation and operands, when an operation has no finite result; over
  /// duals also when it has no finite first or second derivative.
  double evaluate(std::span<const double> values) const;
  Dual evaluate(std::span<const Dual> values) const;
  Dual3 evaluate(std::span<const Dual3> values) const;

  /// f at `values`, and df as these change at `rates`.
  struct Rate {
    double value = 0.0;
    double rate = 0.0;
  };
  /// Adds the derivatives of by_value f + by_rate df to `by_values` by each
  /// value and to `by_rates` by each rate, all of the length of `values`, at
  /// the cost of a few evaluations whatever their number. Throws as
  /// evaluate().
  Rate transpose(std::span<const double> values, std::span<const double> rates,
                 double by_value, double by_rate, std::span<double> by_values,
                 std::span<double> by_rates) const;

  /// As it was read, elements by their names: "2 * t[2,3]".
  const std::string& text() const { return text_; }
  /// Positions of the names that appear, ascending.
  std::vector<int> names_used() const;
  bool is_constant() const;
  /// The position of the name that is all of it; -1: it is more, or none.
  int bare_name() const;

 private:
  friend class ExpressionParser;
  struct Instruction {
    int operation = 0;    // expression_code::Operation
    int index = -1;       // of a name: its position; of a jump: where to
    double number = 0.0;  // of a number
    int column = 0;
  };
  template <class Scalar>
  Scalar run(std::span<const Scalar> values) const;

  std::string text_;
  std::vector<Instruction> code_;  // postfix
};

/// Constants, functions and the coordinates x, y, z, which expressions of a
/// place know: no name of a case may be one.
bool is_reserved_name(std::string_view name);

/// "t[2,3]": the name of an element of the vector t.
std::string element_name(std::string_view vector, std::span<const int> indices);

/// "8 x 12".
std::string shape_text(std::span<const int> shape);

}  // namespace meniscus
