#include "evolve/datafile/fe_expression.h"

#include <optional>
#include <set>

#include <fmt/format.h>

namespace meniscus::datafile {

namespace {

constexpr int kDeepestExpression = 200;
constexpr std::size_t kMostNodes = 4000;

class Parser {
 public:
  Parser(FeLexer& lexer, FeDialect dialect)
      : lexer_(lexer),
        evolver_(dialect != FeDialect::Ours),
        commands_(dialect == FeDialect::Commands) {}

  FeExpression parse_path() {
    expression_.place = lexer_.peek().place;
    path();
    return std::move(expression_);
  }

  FeExpression parse() {
    expression_.place = lexer_.peek().place;
    const int root = difference();
    if (expression_.nodes[root].op == FeOperator::Number) {
      expression_.number = expression_.nodes[root].number;
      expression_.nodes.clear();
    }
    return std::move(expression_);
  }

 private:
  // Counts levels of recursion.
  class Level {
   public:
    explicit Level(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > kDeepestExpression) {
        parser_.lexer_.fail(
            parser_.lexer_.peek().place,
            fmt::format("the expression is nested more than {} deep",
                        kDeepestExpression));
      }
    }
    ~Level() { --parser_.depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    Parser& parser_;
  };

  int node(FeOperator op, const FePlace& place, int a = -1, int b = -1,
           int c = -1) {
    if (expression_.nodes.size() >= kMostNodes) {
      lexer_.fail(place, fmt::format("the expression has more than {} parts",
                                     kMostNodes));
    }
    FeNode made;
    made.op = op;
    made.child = {a, b, c};
    made.place = place;
    expression_.nodes.push_back(std::move(made));
    return static_cast<int>(expression_.nodes.size()) - 1;
  }

  // A sign that begins a new expression: "1 -2".
  bool starts_another(const FeToken& token) const {
    return evolver_ && !commands_ && brackets_ == 0 &&
           (token.is("-") || token.is("+")) && token.after_space &&
           !token.before_space;
  }

  bool skip_if(std::string_view symbol) {
    if (!lexer_.peek().is(symbol)) {
      return false;
    }
    lexer_.take();
    return true;
  }

  // '=' is a minus that binds least.
  int difference() {
    int left = choice();
    while (evolver_ && lexer_.peek().is("=")) {
      const FePlace place = lexer_.take().place;
      left = node(FeOperator::Subtract, place, left, choice());
    }
    return left;
  }

  int choice() {
    const Level level(*this);
    const int condition = either();
    if (!evolver_ || !lexer_.peek().is("?")) {
      return condition;
    }
    const FePlace place = lexer_.take().place;
    const int yes = choice();
    if (!skip_if(":")) {
      lexer_.fail_here("'?' needs its ':'");
    }
    return node(FeOperator::Choose, place, condition, yes, choice());
  }

  int either() {
    int left = both();
    while (evolver_ &&
           (lexer_.peek().is("||") || lexer_.peek().is_name("or"))) {
      const FePlace place = lexer_.take().place;
      left = node(FeOperator::Or, place, left, both());
    }
    return left;
  }

  int both() {
    int left = negation();
    while (evolver_ &&
           (lexer_.peek().is("&&") || lexer_.peek().is_name("and"))) {
      const FePlace place = lexer_.take().place;
      left = node(FeOperator::And, place, left, negation());
    }
    return left;
  }

  int negation() {
    if (evolver_ && (lexer_.peek().is("!") || lexer_.peek().is_name("not"))) {
      const Level level(*this);
      const FePlace place = lexer_.take().place;
      return node(FeOperator::Not, place, negation());
    }
    return comparison();
  }

  static std::optional<FeOperator> comparing(const FeToken& token) {
    if (token.kind != FeToken::Kind::Symbol) {
      return std::nullopt;
    }
    return token.text == "<"    ? FeOperator::Less
           : token.text == "<=" ? FeOperator::LessEqual
           : token.text == ">"  ? FeOperator::Greater
           : token.text == ">=" ? FeOperator::GreaterEqual
           : token.text == "==" ? FeOperator::Equal
           : token.text == "!=" ? std::optional(FeOperator::NotEqual)
                                : std::nullopt;
  }

  int comparison() {
    int left = sum();
    while (const auto op = comparing(lexer_.peek())) {
      const FePlace place = lexer_.take().place;
      left = node(*op, place, left, sum());
    }
    return left;
  }

  int sum() {
    int left = product();
    for (;;) {
      const FeToken& token = lexer_.peek();
      if ((!token.is("+") && !token.is("-")) || starts_another(token)) {
        return left;
      }
      const FeToken sign = lexer_.take();
      left = node(sign.is("+") ? FeOperator::Add : FeOperator::Subtract,
                  sign.place, left, product());
    }
  }

  std::optional<FeOperator> multiplying(const FeToken& token) const {
    if (token.is("*")) {
      return FeOperator::Multiply;
    }
    if (token.is("/")) {
      return FeOperator::Divide;
    }
    if (evolver_ && (token.is("%") || token.is_name("mod"))) {
      return FeOperator::Modulo;
    }
    if (evolver_ && token.is_name("idiv")) {
      return FeOperator::IntegerDivide;
    }
    if (evolver_ && token.is_name("imod")) {
      return FeOperator::IntegerModulo;
    }
    return std::nullopt;
  }

  int product() {
    int left = sign();
    while (const auto op = multiplying(lexer_.peek())) {
      const FePlace place = lexer_.take().place;
      left = node(*op, place, left, sign());
    }
    return left;
  }

  int sign() {
    if (lexer_.peek().is("-")) {
      const Level level(*this);
      const FePlace place = lexer_.take().place;
      return node(FeOperator::Negate, place, sign());
    }
    if (skip_if("+")) {
      const Level level(*this);
      return sign();
    }
    return power();
  }

  int power() {
    int left = atom();
    while (lexer_.peek().is("^") || lexer_.peek().is("**")) {
      const FePlace place = lexer_.take().place;
      const Level level(*this);
      const bool leads =
          lexer_.peek().is("-") || lexer_.peek().is("+") || !evolver_;
      left = node(FeOperator::Power, place, left, leads ? sign() : atom());
    }
    return left;
  }

  int atom() {
    const FeToken& token = lexer_.peek();
    if (token.kind == FeToken::Kind::Number) {
      const int made = node(FeOperator::Number, token.place);
      expression_.nodes[made].number = lexer_.take().number;
      return made;
    }
    if (token.is("(")) {
      lexer_.take();
      ++brackets_;
      const int inside = difference();
      close();
      return inside;
    }
    if (commands_ && token.kind == FeToken::Kind::String) {
      return quoted();
    }
    if (token.kind != FeToken::Kind::Name) {
      lexer_.fail_here("a number, a name or '(' is expected");
    }
    if (commands_) {
      return command_atom();
    }
    FeToken name = lexer_.take();
    if (lexer_.peek().is("(") && function_arguments(name.text) > 0) {
      return call(std::move(name));
    }
    const int made = node(FeOperator::Name, name.place);
    expression_.nodes[made].name = std::move(name.text);
    return made;
  }

  // Texts in a row are one.
  int quoted() {
    const int made = node(FeOperator::Text, lexer_.peek().place);
    while (lexer_.peek().kind == FeToken::Kind::String) {
      expression_.nodes[made].name += lexer_.take().text;
    }
    return made;
  }

  int command_atom() {
    static const std::set<std::string, std::less<>> kAggregates = {
        "max", "min", "sum", "avg", "count"};
    static const std::set<std::string, std::less<>> kTests = {
        "on_constraint", "on_boundary",        "hit_constraint",
        "on_quantity",   "on_method_instance", "value_of_constraint"};
    const std::string word = lexer_.peek().text;
    if (kAggregates.count(word) != 0) {
      return aggregate();
    }
    if (kTests.count(word) != 0) {
      const Level level(*this);
      const FePlace place = lexer_.take().place;
      const int made = node(FeOperator::Member, place, -1, atom());
      expression_.nodes[made].name = word;
      return made;
    }
    if (function_arguments(word) > 0) {
      FeToken name = lexer_.take();
      if (!lexer_.peek().is("(")) {
        lexer_.fail_here(fmt::format("'(' is expected behind {}", word));
      }
      return call(std::move(name));
    }
    return path();
  }

  int path() {
    int owner = -1;
    do {
      if (lexer_.peek().kind != FeToken::Kind::Name) {
        lexer_.fail_here("a name is expected");
      }
      FeToken name = lexer_.take();
      std::array<int, 2> index{-1, -1};
      for (int& k : index) {
        if (skip_if("[")) {
          k = difference();
          if (!skip_if("]")) {
            lexer_.fail_here("']' is expected");
          }
        }
      }
      const bool plain = owner < 0 && index[0] < 0;
      const int made = node(plain ? FeOperator::Name : FeOperator::Member,
                            name.place, owner, index[0], index[1]);
      expression_.nodes[made].name = std::move(name.text);
      owner = made;
    } while (skip_if("."));
    return owner;
  }

  // sum(facet ff where ff.area > 1, ff.area)
  int aggregate() {
    const Level level(*this);
    FeToken name = lexer_.take();
    if (!skip_if("(")) {
      lexer_.fail_here(fmt::format("'(' is expected behind {}", name.text));
    }
    const int elements = path();
    std::string variable;
    if (lexer_.peek().kind == FeToken::Kind::Name &&
        !lexer_.peek().is_name("where")) {
      variable = lexer_.take().text;
    }
    int condition = -1;
    if (lexer_.peek().is_name("where")) {
      lexer_.take();
      condition = difference();
    }
    const int value = skip_if(",") ? difference() : -1;
    if (!skip_if(")")) {
      lexer_.fail_here("')' is expected");
    }
    const int made =
        node(FeOperator::Aggregate, name.place, elements, condition, value);
    expression_.nodes[made].name = std::move(name.text);
    expression_.nodes[made].variable = std::move(variable);
    return made;
  }

  int call(FeToken name) {
    const int wanted = function_arguments(name.text);
    lexer_.take();
    ++brackets_;
    std::array<int, 3> arguments{-1, -1, -1};
    for (int k = 0; k < wanted; ++k) {
      if (k > 0 && !skip_if(",")) {
        lexer_.fail_here(fmt::format("{}() has {} arguments; a ',' is expected",
                                     name.text, wanted));
      }
      arguments[k] = difference();
    }
    close();
    const int made = node(FeOperator::Call, name.place, arguments[0],
                          arguments[1], arguments[2]);
    expression_.nodes[made].name = std::move(name.text);
    return made;
  }

  void close() {
    // The token behind the bracket belongs outside.
    if (!lexer_.peek().is(")")) {
      lexer_.fail_here("')' is expected");
    }
    --brackets_;
    lexer_.take();
  }

  FeLexer& lexer_;
  bool evolver_ = true;
  bool commands_ = false;
  FeExpression expression_;
  int depth_ = 0;
  int brackets_ = 0;
};

}  // namespace

FeExpression parse_expression(FeLexer& lexer, FeDialect dialect) {
  return Parser(lexer, dialect).parse();
}

FeExpression parse_path(FeLexer& lexer) {
  return Parser(lexer, FeDialect::Commands).parse_path();
}

}  // namespace meniscus::datafile
