/// Arithmetic of Surface Evolver datafiles: parsed into a tree, then either
/// evaluated to a number or compiled into an Expression of the place.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/math/expression.h"
#include "evolve/datafile/fe_lexer.h"

namespace meniscus::datafile {

enum class FeOperator {
  Number,
  Name,
  Negate,
  Not,
  Add,
  Subtract,
  Multiply,
  Divide,
  Modulo,         // x - floor(x / y) y
  IntegerDivide,  // rounds both toward zero first
  IntegerModulo,  // of the floors
  Power,
  Less,
  LessEqual,
  Greater,
  GreaterEqual,
  Equal,
  NotEqual,
  And,
  Or,
  Choose,  // condition ? a : b
  Call,    // name(a) or name(a, b)
  // In commands only:
  Member,     // child 0 . name [child 1] [child 2], -1 where there is none
  Aggregate,  // name(child 0 variable where child 1, child 2), name = sum, ...
  Text        // "name"
};

struct FeNode {
  FeOperator op = FeOperator::Number;
  double number = 0.0;
  std::string name;      // Name, Call, Member, Aggregate: in lower case
  std::string variable;  // Aggregate: name of the element at hand, or empty
  std::array<int, 3> child{-1, -1, -1};  // indices of earlier nodes
  FePlace place;
};

/// A number, or a tree whose root is the last node.
struct FeExpression {
  double number = 0.0;
  std::vector<FeNode> nodes;  // empty: the number
  FePlace place;

  bool is_number() const { return nodes.empty(); }
};

/// How text groups. Evolver: a ^ b ^ c is (a ^ b) ^ c and, outside brackets, a
/// sign behind a space and right before its operand begins a new expression.
/// Commands: the same without that, with elements, their attributes, sums over
/// them and texts. Ours: core/math/expression.h.
enum class FeDialect { Evolver, Commands, Ours };

/// The longest expression at hand. Throws InvalidInput for broken syntax,
/// unknown functions, more than 200 levels of nesting or 4,000 operations.
FeExpression parse_expression(FeLexer& lexer,
                              FeDialect dialect = FeDialect::Evolver);

/// "vertex[3].edge", "body", "x": a Name or Members, as commands have them.
FeExpression parse_path(FeLexer& lexer);

/// Values by name in lower case.
using FeValues = std::map<std::string, double, std::less<>>;

/// Names that stay names, and what they are called in ours: x1 -> x, p1 -> t.
using FeUnknowns = std::map<std::string, std::string, std::less<>>;
const FeUnknowns& place_names();      // x y z x1 x2 x3 -> x y z
const FeUnknowns& parameter_names();  // p1 -> t

/// How many arguments the function has; 0: there is none of that name.
int function_arguments(std::string_view name);

/// What the node makes of its children's values; not for names, members,
/// aggregates and texts.
double operation_value(const FeNode& node, double a, double b, double c);

/// Every name in the expression, in order of appearance, repeats kept.
std::vector<const FeNode*> names_in(const FeExpression& expression);

/// Throw InvalidInput "file:line:column: what": a name without value, a result
/// that is not finite, an operation that ours lacks (% of a coordinate).
double number_of(const FeExpression& expression, const FeValues& values,
                 const std::string& file);
Expression compiled(const FeExpression& expression, const FeValues& values,
                    const FeUnknowns& unknowns, const std::string& file);

/// `expression`, of x, y, z or of t, as text for a datafile; t is called p1.
/// Throws InvalidInput when it cannot be said there.
std::string fe_expression_text(const Expression& expression);

/// As the language counts what holds.
inline double truth(bool holds) { return holds ? 1.0 : 0.0; }

}  // namespace meniscus::datafile
