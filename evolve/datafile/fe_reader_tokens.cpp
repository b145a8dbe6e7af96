// Single numbers, texts and formulas of the datafile reader.
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/nearest_name.h"
#include "evolve/datafile/fe_reader.h"

namespace meniscus::datafile {

namespace {

// Names of colours are numbers wherever they stand.
const std::set<std::string, std::less<>>& colours() {
  static const std::set<std::string, std::less<>> names = {
      "clear",        "transparent", "black",    "blue",      "green",
      "cyan",         "red",         "magenta",  "brown",     "lightgray",
      "darkgray",     "lightgrey",   "darkgrey", "lightblue", "lightgreen",
      "lightcyan",    "lightred",    "yellow",   "white",     "grey",
      "lightmagenta", "gray"};
  return names;
}

}  // namespace

bool FeReader::signed_integer_ahead() {
  const FeToken& token = lexer_.peek();
  return token.kind == FeToken::Kind::Number || token.is("-") || token.is("+");
}

int FeReader::integer(const char* what) {
  const bool negative = lexer_.peek().is("-");
  if (negative || lexer_.peek().is("+")) {
    lexer_.take();
  }
  const FeToken& token = lexer_.peek();
  constexpr double kLargest = std::numeric_limits<int>::max() - 1;
  if (token.kind != FeToken::Kind::Number ||
      token.number != std::floor(token.number) || token.number > kLargest) {
    lexer_.fail_here(fmt::format("{} is expected, a whole number", what));
  }
  const int number = static_cast<int>(lexer_.take().number);
  return negative ? -number : number;
}

std::string FeReader::string(const char* what) {
  skip_separators();
  if (lexer_.peek().kind != FeToken::Kind::String) {
    lexer_.fail_here(fmt::format("{} in quotes is expected", what));
  }
  return lexer_.take().text;
}

void FeReader::accept(std::string_view symbol) {
  while (symbol != lexer_.peek().text && lexer_.peek().is(":")) {
    lexer_.take();
  }
  if (!lexer_.peek().is(symbol)) {
    lexer_.fail_here(fmt::format("'{}' is expected", symbol));
  }
  lexer_.take();
}

// Three formulas "e1: ... e2: ... e3: ...".
FeField FeReader::field(const char* letter, Sees sees,
                        std::optional<FeElement> owner) {
  FeField made;
  for (std::size_t k = 0; k < made.size(); ++k) {
    skip_separators();
    const std::string label = letter + std::to_string(k + 1);
    if (!lexer_.peek().is_name(label)) {
      lexer_.fail_here(fmt::format("'{}:' is expected", label));
    }
    lexer_.take();
    skip_separators();
    made[k] = formula(sees, owner);
  }
  return made;
}

FeExpression FeReader::formula(Sees sees, std::optional<FeElement> owner) {
  FeExpression expression = parse_expression(lexer_);
  for (const FeNode* node : names_in(expression)) {
    check_name(*node, sees, owner);
  }
  return expression;
}

void FeReader::check_name(const FeNode& node, Sees sees,
                          std::optional<FeElement> owner) {
  const std::string& name = node.name;
  const bool known =
      name == "pi" || name == "g" || parameters_.count(name) != 0 ||
      colours().count(name) != 0 ||
      (sees == Sees::Place && place_names().count(name) != 0) ||
      (sees == Sees::Parameter && parameter_names().count(name) != 0) ||
      (owner && attribute_index(*owner, name) >= 0);
  if (known) {
    return;
  }
  std::vector<std::string> candidates(parameters_.begin(), parameters_.end());
  const std::string near = nearest_name(name, candidates);
  lexer_.fail(node.place,
              fmt::format("'{}' is not defined here{}", name,
                          near.empty() ? "" : "; is '" + near + "' meant?"));
}

int FeReader::attribute_index(FeElement element,
                              const std::string& name) const {
  for (std::size_t k = 0; k < file_.attributes.size(); ++k) {
    if (file_.attributes[k].element == element &&
        file_.attributes[k].name == name) {
      return static_cast<int>(k);
    }
  }
  return -1;
}

}  // namespace meniscus::datafile
