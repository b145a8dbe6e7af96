#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/macaulay.h"
#include "evolve/datafile/fe_expression.h"

namespace meniscus::datafile {

namespace {

[[noreturn]] void fail(const std::string& file, const FePlace& place,
                       const std::string& what) {
  throw InvalidInput(
      fmt::format("{}:{}:{}: {}", file, place.line, place.column, what));
}

using Unary = double (*)(double);
using Binary = double (*)(double, double);

double clamped(double x) { return std::fmin(1.0, std::fmax(-1.0, x)); }

const std::map<std::string_view, Unary>& unary_functions() {
  static const std::map<std::string_view, Unary> table = {
      {"abs", [](double x) { return std::abs(x); }},
      {"sqr", [](double x) { return x * x; }},
      {"sqrt", [](double x) { return std::sqrt(x); }},
      {"sin", [](double x) { return std::sin(x); }},
      {"cos", [](double x) { return std::cos(x); }},
      {"tan", [](double x) { return std::tan(x); }},
      // Arguments of these two are clamped, as in Evolver.
      {"acos", [](double x) { return std::acos(clamped(x)); }},
      {"asin", [](double x) { return std::asin(clamped(x)); }},
      {"atan", [](double x) { return std::atan(x); }},
      {"log", [](double x) { return std::log(x); }},
      {"log10", [](double x) { return std::log10(x); }},
      {"exp", [](double x) { return std::exp(x); }},
      {"sinh", [](double x) { return std::sinh(x); }},
      {"cosh", [](double x) { return std::cosh(x); }},
      {"tanh", [](double x) { return std::tanh(x); }},
      {"asinh", [](double x) { return std::asinh(x); }},
      {"acosh", [](double x) { return std::acosh(x); }},
      {"atanh", [](double x) { return std::atanh(x); }},
      {"ceil", [](double x) { return std::ceil(x); }},
      {"floor", [](double x) { return std::floor(x); }},
  };
  return table;
}

const std::map<std::string_view, Binary>& binary_functions() {
  static const std::map<std::string_view, Binary> table = {
      {"atan2", [](double x, double y) { return std::atan2(x, y); }},
      {"pow", [](double x, double y) { return std::pow(x, y); }},
      {"min", [](double x, double y) { return std::fmin(x, y); }},
      {"minimum", [](double x, double y) { return std::fmin(x, y); }},
      {"max", [](double x, double y) { return std::fmax(x, y); }},
      {"maximum", [](double x, double y) { return std::fmax(x, y); }},
  };
  return table;
}

double function_value(const std::string& name, double a, double b, double c) {
  if (const auto found = unary_functions().find(name);
      found != unary_functions().end()) {
    return found->second(a);
  }
  if (const auto found = binary_functions().find(name);
      found != binary_functions().end()) {
    return found->second(a, b);
  }
  if (name == "macaulay") {
    return macaulay(a, b, c);
  }
  return a != 0.0 ? b : c;  // if
}

}  // namespace

double operation_value(const FeNode& node, double a, double b, double c) {
  switch (node.op) {
    case FeOperator::Number:
    case FeOperator::Name:
      return node.number;
    case FeOperator::Negate:
      return -a;
    case FeOperator::Not:
      return truth(a == 0.0);
    case FeOperator::Add:
      return a + b;
    case FeOperator::Subtract:
      return a - b;
    case FeOperator::Multiply:
      return a * b;
    case FeOperator::Divide:
      return a / b;
    case FeOperator::Modulo:
      return a - std::floor(a / b) * b;
    case FeOperator::IntegerDivide:
      return std::trunc(std::trunc(a) / std::trunc(b));
    case FeOperator::IntegerModulo:
      return std::floor(a) -
             std::floor(std::floor(a) / std::floor(b)) * std::floor(b);
    case FeOperator::Power:
      return std::pow(a, b);
    case FeOperator::Less:
      return truth(a < b);
    case FeOperator::LessEqual:
      return truth(a <= b);
    case FeOperator::Greater:
      return truth(a > b);
    case FeOperator::GreaterEqual:
      return truth(a >= b);
    case FeOperator::Equal:
      return truth(a == b);
    case FeOperator::NotEqual:
      return truth(a != b);
    case FeOperator::And:
      return truth(a != 0.0 && b != 0.0);
    case FeOperator::Or:
      return truth(a != 0.0 || b != 0.0);
    case FeOperator::Choose:
      return a != 0.0 ? b : c;
    case FeOperator::Call:
      return function_value(node.name, a, b, c);
    default:
      return std::nan("");  // commands only: refused before
  }
}

namespace {

// How tightly a text holds together.
enum class Grip { Comparison, Sum, Product, Power, Atom };

struct Text {
  std::string text;
  Grip grip = Grip::Atom;

  std::string within(Grip least) const {
    return grip >= least ? text : "(" + text + ")";
  }
};

// One node, its children given: a number where all below is known, or text.
struct Piece {
  std::optional<double> number;
  Text text;
};

Text number_text(double number) {
  return {fmt::format("{}", number),
          std::signbit(number) ? Grip::Sum : Grip::Atom};
}

class Writer {
 public:
  Writer(const FeExpression& expression, const FeValues& values,
         const FeUnknowns& unknowns, const std::string& file, FeDialect dialect)
      : expression_(expression),
        values_(values),
        unknowns_(unknowns),
        file_(file),
        ours_(dialect == FeDialect::Ours) {}

  Piece write() {
    if (expression_.is_number()) {
      return {expression_.number, {}};
    }
    // Children stand before their parents, each used once.
    std::vector<Piece> pieces;
    pieces.reserve(expression_.nodes.size());
    for (const FeNode& node : expression_.nodes) {
      pieces.push_back(piece(node, pieces));
    }
    if (pieces.back().number && !std::isfinite(*pieces.back().number)) {
      fail(file_, expression_.place,
           fmt::format("the expression's value is {}", *pieces.back().number));
    }
    return std::move(pieces.back());
  }

 private:
  Piece piece(const FeNode& node, std::vector<Piece>& pieces) {
    if (node.op == FeOperator::Number) {
      return {node.number, {}};
    }
    if (node.op == FeOperator::Name) {
      return named(node);
    }
    if (node.op == FeOperator::Member || node.op == FeOperator::Aggregate ||
        node.op == FeOperator::Text) {
      fail(file_, node.place,
           fmt::format("'{}' belongs to commands, not to formulas", node.name));
    }
    std::array<Piece, 3> below;
    bool known = true;
    for (int k = 0; k < 3; ++k) {
      if (node.child[k] >= 0) {
        below[k] = std::move(pieces[node.child[k]]);
        known = known && below[k].number.has_value();
      }
    }
    if (known) {
      return {operation_value(node, below[0].number.value_or(0.0),
                              below[1].number.value_or(0.0),
                              below[2].number.value_or(0.0)),
              {}};
    }
    const bool chooses = node.op == FeOperator::Choose ||
                         (node.op == FeOperator::Call && node.name == "if");
    if (chooses && below[0].number) {
      return std::move(below[*below[0].number != 0.0 ? 1 : 2]);
    }
    if (node.op == FeOperator::Call && node.name == "macaulay" &&
        !below[1].number) {
      fail(file_, node.place, "a bracket whose power varies is not supported");
    }
    for (Piece& part : below) {
      if (part.number) {
        if (!std::isfinite(*part.number)) {
          fail(file_, node.place,
               fmt::format("a part of the expression is {}", *part.number));
        }
        part.text = number_text(*part.number);
      }
    }
    return {std::nullopt,
            text_of(node, below[0].text, below[1].text, below[2].text)};
  }

  Piece named(const FeNode& node) const {
    if (const auto found = unknowns_.find(node.name);
        found != unknowns_.end()) {
      return {std::nullopt, {found->second, Grip::Atom}};
    }
    if (const auto found = values_.find(node.name); found != values_.end()) {
      return {found->second, {}};
    }
    fail(file_, node.place, fmt::format("'{}' has no value here", node.name));
  }

  static Text infix(const Text& a, const char* sign, const Text& b, Grip own) {
    // a - (b - c), a^(b^c); comparisons never chain.
    const Grip left = own == Grip::Power        ? Grip::Atom
                      : own == Grip::Comparison ? Grip::Sum
                                                : own;
    const Grip right = own == Grip::Sum       ? Grip::Product
                       : own == Grip::Product ? Grip::Power
                                              : left;
    return {a.within(left) + sign + b.within(right), own};
  }

  Text if_text(const Text& a, const std::string& b, const std::string& c) {
    if (ours_) {
      return {fmt::format("if({}, {}, {})", a.text, b, c), Grip::Atom};
    }
    return {fmt::format("(({}) ? ({}) : ({}))", a.text, b, c), Grip::Atom};
  }

  Text text_of(const FeNode& node, const Text& a, const Text& b,
               const Text& c) {
    switch (node.op) {
      case FeOperator::Negate:
        return {"-" + a.within(Grip::Power), Grip::Sum};
      case FeOperator::Not:
        return infix(a, " == ", {"0", Grip::Atom}, Grip::Comparison);
      case FeOperator::Add:
        return infix(a, " + ", b, Grip::Sum);
      case FeOperator::Subtract:
        return infix(a, " - ", b, Grip::Sum);
      case FeOperator::Multiply:
        return infix(a, "*", b, Grip::Product);
      case FeOperator::Divide:
        return infix(a, "/", b, Grip::Product);
      case FeOperator::Power:
        return infix(a, "^", b, Grip::Power);
      case FeOperator::Less:
        return infix(a, " < ", b, Grip::Comparison);
      case FeOperator::LessEqual:
        return infix(a, " <= ", b, Grip::Comparison);
      case FeOperator::Greater:
        return infix(a, " > ", b, Grip::Comparison);
      case FeOperator::GreaterEqual:
        return infix(a, " >= ", b, Grip::Comparison);
      case FeOperator::Equal:
        return infix(a, " == ", b, Grip::Comparison);
      case FeOperator::NotEqual:
        return infix(a, " != ", b, Grip::Comparison);
      case FeOperator::And:
        return if_text(a, b.within(Grip::Sum) + " != 0", "0");
      case FeOperator::Or:
        return if_text(a, "1", b.within(Grip::Sum) + " != 0");
      case FeOperator::Choose:
        return if_text(a, b.text, c.text);
      case FeOperator::Call:
        return call_text(node, a, b, c);
      default:
        fail(file_, node.place,
             "remainders (%, idiv, imod) of coordinates are not supported");
    }
  }

  /// Evolver has no such function.
  Text macaulay_text(const Text& s, const Text& n, const Text& w) {
    if (ours_) {
      return {fmt::format("macaulay({}, {}, {})", s.text, n.text, w.text),
              Grip::Atom};
    }
    const bool switches = n.text == "0";
    if (w.text == "0") {
      return switches
                 ? if_text(infix(s, " < ", {"0", Grip::Atom}, Grip::Comparison),
                           "0", "1")
                 : infix({fmt::format("maximum({}, 0)", s.text)}, "^", n,
                         Grip::Power);
    }
    const std::string root =
        fmt::format("sqrt(sqr({}) + sqr({}))", s.text, w.text);
    return switches
               ? Text{fmt::format("(1 + {}/{})/2", s.within(Grip::Power), root),
                      Grip::Product}
               : infix(
                     {fmt::format("(({} + {})/2)", s.within(Grip::Sum), root)},
                     "^", n, Grip::Power);
  }

  Text call_text(const FeNode& node, const Text& a, const Text& b,
                 const Text& c) {
    std::string name = node.name;
    if (name == "if") {
      return if_text(a, b.text, c.text);
    }
    if (name == "macaulay") {
      return macaulay_text(a, b, c);
    }
    if (name == "ceil" || name == "floor") {
      fail(file_, node.place,
           fmt::format("{}() of coordinates is not supported", name));
    }
    if (name == "asinh") {
      return {fmt::format("log({0} + sqrt(sqr({1}) + 1))", a.within(Grip::Sum),
                          a.text),
              Grip::Atom};
    }
    if (name == "acosh") {
      return {fmt::format("log({0} + sqrt(sqr({1}) - 1))", a.within(Grip::Sum),
                          a.text),
              Grip::Atom};
    }
    if (name == "atanh") {
      return {
          fmt::format("0.5*log((1 + {0})/(1 - {0}))", a.within(Grip::Product)),
          Grip::Product};
    }
    if (!ours_ && name == "log10") {
      return {fmt::format("log({})/log(10)", a.text), Grip::Product};
    }
    if (name == "min" || name == "minimum") {
      name = ours_ ? "min" : "minimum";
    } else if (name == "max" || name == "maximum") {
      name = ours_ ? "max" : "maximum";
    }
    return {node.child[1] < 0 ? fmt::format("{}({})", name, a.text)
                              : fmt::format("{}({}, {})", name, a.text, b.text),
            Grip::Atom};
  }

  const FeExpression& expression_;
  const FeValues& values_;
  const FeUnknowns& unknowns_;
  const std::string& file_;
  bool ours_ = true;
};

}  // namespace

double number_of(const FeExpression& expression, const FeValues& values,
                 const std::string& file) {
  static const FeUnknowns kNone;
  const Piece piece =
      Writer(expression, values, kNone, file, FeDialect::Ours).write();
  return *piece.number;
}

Expression compiled(const FeExpression& expression, const FeValues& values,
                    const FeUnknowns& unknowns, const std::string& file) {
  const Piece piece =
      Writer(expression, values, unknowns, file, FeDialect::Ours).write();
  if (piece.number) {
    return Expression(*piece.number);
  }
  std::vector<std::string> names;
  for (const auto& [theirs, ours] : unknowns) {
    if (theirs == ours || unknowns.size() == 1) {
      names.push_back(ours);
    }
  }
  try {
    return Expression::parse(piece.text.text, names);
  } catch (const ExpressionError& error) {
    fail(file, expression.place, error.what());
  }
}

std::string fe_expression_text(const Expression& expression) {
  static const FeUnknowns kNames = {
      {"x", "x"}, {"y", "y"}, {"z", "z"}, {"t", "p1"}};
  static const FeValues kValues = {{"pi", 3.14159265358979323846},
                                   {"e", 2.71828182845904523536},
                                   {"deg", 3.14159265358979323846 / 180.0}};
  const std::string source = "expression";
  FeLexer lexer(expression.text(), source);
  const FeExpression parsed = parse_expression(lexer, FeDialect::Ours);
  const Piece piece =
      Writer(parsed, kValues, kNames, source, FeDialect::Evolver).write();
  return piece.number ? number_text(*piece.number).text : piece.text.text;
}

}  // namespace meniscus::datafile
