/// Operations of compiled expressions: shared by the parser and the evaluators
/// of core/math/expression.h and measure.h, nothing else needs it.
#pragma once

#include <array>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "core/math/measure.h"

namespace meniscus::expression_code {

/// What names are made of; a digit is not their first.
constexpr bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

enum Operation : int {
  Number,
  Name,
  JumpIfZero,  // takes the condition off the stack
  Jump,
  Negate,
  Add,
  Subtract,
  Multiply,
  Divide,
  Power,
  Less,
  LessEqual,
  Greater,
  GreaterEqual,
  Equal,
  NotEqual,
  FirstFunction
};

struct Function {
  const char* name;
  int arguments;
};
constexpr std::array<Function, 20> kFunctions = {{
    {"sin", 1},   {"cos", 1},   {"tan", 1},  {"asin", 1}, {"acos", 1},
    {"atan", 1},  {"sinh", 1},  {"cosh", 1}, {"tanh", 1}, {"exp", 1},
    {"log", 1},   {"log10", 1}, {"sqrt", 1}, {"abs", 1},  {"sqr", 1},
    {"atan2", 2}, {"min", 2},   {"max", 2},  {"pow", 2},  {"macaulay", 3},
}};

/// if(condition, then, else) is no function: only one of its branches runs.
constexpr const char* kConditional = "if";

struct Constant {
  const char* name;
  double value;
};
constexpr std::array<Constant, 3> kConstants = {
    {{"pi", std::numbers::pi},
     {"e", std::numbers::e},
     {"deg", std::numbers::pi / 180.0}}};

/// One step of postfix code, as the parser hands it on.
struct Step {
  int operation = Number;
  int index = -1;       // of a name: its position; of a jump: where to
  double number = 0.0;  // of a number
  int column = 0;
};
/// The dimension that the code leaves (core/math/measure.h).
Measure measure_steps(const std::vector<Step>& code, const std::string& text,
                      std::span<const Measure> names);

constexpr int arity(int operation) {
  if (operation >= FirstFunction) {
    return kFunctions[static_cast<std::size_t>(operation - FirstFunction)]
        .arguments;
  }
  return operation < Negate ? 0 : operation == Negate ? 1 : 2;
}

}  // namespace meniscus::expression_code
