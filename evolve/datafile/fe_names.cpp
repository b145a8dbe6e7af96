// What names mean in the formulas of datafiles.
#include "evolve/datafile/fe_expression.h"

namespace meniscus::datafile {

int function_arguments(std::string_view name) {
  static const std::map<std::string, int, std::less<>> known = {
      {"abs", 1},   {"sqr", 1},     {"sqrt", 1}, {"sin", 1},
      {"cos", 1},   {"tan", 1},     {"acos", 1}, {"asin", 1},
      {"atan", 1},  {"atan2", 2},   {"log", 1},  {"exp", 1},
      {"sinh", 1},  {"cosh", 1},    {"tanh", 1}, {"asinh", 1},
      {"acosh", 1}, {"atanh", 1},   {"pow", 2},  {"ceil", 1},
      {"floor", 1}, {"minimum", 2}, {"min", 2},  {"maximum", 2},
      {"max", 2},   {"log10", 1},   {"if", 3},   {"macaulay", 3},
  };
  const auto found = known.find(name);
  return found == known.end() ? 0 : found->second;
}

const FeUnknowns& place_names() {
  static const FeUnknowns names = {{"x", "x"},  {"y", "y"},  {"z", "z"},
                                   {"x1", "x"}, {"x2", "y"}, {"x3", "z"}};
  return names;
}

const FeUnknowns& parameter_names() {
  static const FeUnknowns names = {{"p1", "t"}};
  return names;
}

std::vector<const FeNode*> names_in(const FeExpression& expression) {
  std::vector<const FeNode*> names;
  for (const FeNode& node : expression.nodes) {
    if (node.op == FeOperator::Name) {
      names.push_back(&node);
    }
  }
  return names;
}

}  // namespace meniscus::datafile
