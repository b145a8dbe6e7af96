#include "core/expression.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

namespace meniscus {

namespace {

constexpr int kDeepest = 200;
constexpr std::size_t kLongest = 10000;

enum Operation : int {
  Number,
  Name,
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
    {"atan2", 2}, {"min", 2},   {"max", 2},  {"pow", 2},  {"if", 3},
}};

struct Constant {
  const char* name;
  double value;
};
constexpr std::array<Constant, 3> kConstants = {
    {{"pi", std::numbers::pi},
     {"e", std::numbers::e},
     {"deg", std::numbers::pi / 180.0}}};

int arity(int operation) {
  if (operation >= FirstFunction) {
    return kFunctions[operation - FirstFunction].arguments;
  }
  return operation <= Name ? 0 : operation == Negate ? 1 : 2;
}

const char* symbol(int operation) {
  constexpr std::array<const char*, FirstFunction> kSymbols = {
      "number", "name", "-",  "+", "-",  "*",  "/",
      "^",      "<",    "<=", ">", ">=", "==", "!="};
  return operation >= FirstFunction ? kFunctions[operation - FirstFunction].name
                                    : kSymbols[operation];
}

double value_of(double x) { return x; }
double value_of(const Dual& x) { return x.value; }

bool is_finite(double x) { return std::isfinite(x); }
bool is_finite(const Dual& x) {
  return std::isfinite(x.value) && x.gradient.allFinite() &&
         x.hessian.allFinite();
}

template <class Scalar>
Scalar apply_binary(int operation, const Scalar& a, const Scalar& b) {
  using std::pow;
  const double x = value_of(a);
  const double y = value_of(b);
  switch (operation) {
    case Add:
      return a + b;
    case Subtract:
      return a - b;
    case Multiply:
      return a * b;
    case Divide:
      return a / b;
    case Power:
      return pow(a, b);
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
      return value_of(a[0]) != 0.0 ? a[1] : a[2];
  }
}

template <class Scalar>
[[noreturn]] void not_finite(int operation, const Scalar* operands, int count,
                             const std::string& text, int column) {
  if (operation == Divide && value_of(operands[1]) == 0.0) {
    throw ExpressionError(fmt::format("division of {:g} by zero in '{}'",
                                      value_of(operands[0]), text),
                          column);
  }
  std::string values;
  for (int k = 0; k < count; ++k) {
    values += fmt::format("{}{:g}", k == 0 ? "" : ", ", value_of(operands[k]));
  }
  throw ExpressionError(fmt::format("{}({}) in '{}' is not a finite number",
                                    symbol(operation), values, text),
                        column);
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

/// Recursive descent into postfix code.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, const std::vector<std::string>& names)
      : text_(text), names_(names) {}

  Expression parse() {
    if (text_.size() > kLongest) {
      throw ExpressionError(
          fmt::format("expression of {} characters; at most {} are read",
                      text_.size(), kLongest),
          1);
    }
    comparison();
    skip_space();
    if (at_ < text_.size()) {
      fail(text_[at_] == ')' ? "')' without its '('"
                             : fmt::format("unexpected '{}'", here()));
    }
    Expression result;
    result.text_ = text_;
    result.code_ = std::move(code_);
    return result;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ExpressionError(fmt::format("{} in '{}'", message, shown()),
                          static_cast<int>(at_) + 1);
  }
  std::string shown() const {
    return text_.size() <= 80 ? std::string(text_)
                              : std::string(text_.substr(0, 77)) + "...";
  }
  std::string here() const {
    return at_ < text_.size() ? std::string(1, text_[at_]) : "end";
  }
  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) {
      ++at_;
    }
  }
  bool take(std::string_view token) {
    skip_space();
    if (text_.substr(at_, token.size()) != token) {
      return false;
    }
    at_ += token.size();
    return true;
  }
  void emit(int operation, std::size_t column) {
    code_.push_back(
        {.operation = operation, .column = static_cast<int>(column) + 1});
  }

  void comparison() {
    if (++depth_ > kDeepest) {
      fail(fmt::format("more than {} levels of nesting", kDeepest));
    }
    sum();
    struct Token {
      const char* text;
      int operation;
    };
    constexpr std::array<Token, 6> kTokens = {{{"<=", LessEqual},
                                               {">=", GreaterEqual},
                                               {"==", Equal},
                                               {"!=", NotEqual},
                                               {"<", Less},
                                               {">", Greater}}};
    for (const Token& token : kTokens) {
      if (take(token.text)) {
        const std::size_t column = at_ - 1;
        sum();
        emit(token.operation, column);
        break;
      }
    }
    --depth_;
  }

  void sum() {
    product();
    while (true) {
      const int operation = take("+") ? Add : take("-") ? Subtract : Number;
      if (operation == Number) {
        return;
      }
      const std::size_t column = at_ - 1;
      product();
      emit(operation, column);
    }
  }

  void product() {
    unary();
    while (true) {
      const int operation = take("*") ? Multiply : take("/") ? Divide : Number;
      if (operation == Number) {
        return;
      }
      const std::size_t column = at_ - 1;
      unary();
      emit(operation, column);
    }
  }

  void unary() {
    bool negative = false;
    std::size_t column = at_;
    while (true) {
      if (take("-")) {
        column = at_ - 1;
        negative = !negative;
      } else if (!take("+")) {
        break;
      }
    }
    power();
    if (negative) {
      emit(Negate, column);
    }
  }

  void power() {
    primary();
    if (take("^")) {
      const std::size_t column = at_ - 1;
      if (++depth_ > kDeepest) {
        fail(fmt::format("more than {} levels of nesting", kDeepest));
      }
      unary();  // right associative; 2^-3 is allowed
      --depth_;
      emit(Power, column);
    }
  }

  void primary() {
    skip_space();
    if (at_ >= text_.size()) {
      fail("a value is missing at the end");
    }
    const char c = text_[at_];
    if (take("(")) {
      comparison();
      close();
    } else if (is_digit(c) || c == '.') {
      number();
    } else if (is_letter(c)) {
      name();
    } else {
      fail(fmt::format("a value is missing before '{}'", here()));
    }
  }

  void close() {
    if (!take(")")) {
      fail(fmt::format("')' is missing before '{}'", here()));
    }
  }

  void number() {
    double value = 0.0;
    const auto [end, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) {
      fail("a number that cannot be read");
    }
    emit(Number, at_);
    code_.back().number = value;
    at_ = static_cast<std::size_t>(end - text_.data());
  }

  void name() {
    const std::size_t column = at_;
    while (at_ < text_.size() &&
           (is_letter(text_[at_]) || is_digit(text_[at_]))) {
      ++at_;
    }
    const std::string word(text_.substr(column, at_ - column));
    if (take("(")) {
      call(word, column);
      return;
    }
    const auto known = std::find(names_.begin(), names_.end(), word);
    if (known != names_.end()) {
      emit(Name, column);
      code_.back().name = static_cast<int>(known - names_.begin());
      return;
    }
    for (const Constant& constant : kConstants) {
      if (word == constant.name) {
        emit(Number, column);
        code_.back().number = constant.value;
        return;
      }
    }
    at_ = column;
    fail("unknown name '" + word + "'" + suggestion(word, names_));
  }

  void call(const std::string& word, std::size_t column) {
    const auto function =
        std::find_if(kFunctions.begin(), kFunctions.end(),
                     [&](const Function& f) { return word == f.name; });
    if (function == kFunctions.end()) {
      std::vector<std::string> known;
      for (const Function& f : kFunctions) {
        known.emplace_back(f.name);
      }
      at_ = column;
      fail("unknown function '" + word + "'" + suggestion(word, known));
    }
    for (int k = 0; k < function->arguments; ++k) {
      if (k > 0 && !take(",")) {
        fail(fmt::format("{} takes {} arguments, ',' is missing", word,
                         function->arguments));
      }
      comparison();
    }
    if (take(",")) {
      fail(fmt::format("{} takes {} argument{}", word, function->arguments,
                       function->arguments == 1 ? "" : "s"));
    }
    close();
    emit(FirstFunction + static_cast<int>(function - kFunctions.begin()),
         column);
  }

  static std::string suggestion(const std::string& word,
                                const std::vector<std::string>& known) {
    const std::string near = nearest_name(word, known);
    return near.empty() ? "" : " (did you mean '" + near + "'?)";
  }

  std::string_view text_;
  const std::vector<std::string>& names_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<Expression::Instruction> code_;
};

Expression::Expression(double constant) : text_(fmt::format("{}", constant)) {
  code_.push_back({.operation = Number, .number = constant, .column = 1});
}

Expression Expression::parse(std::string_view text,
                             const std::vector<std::string>& names) {
  return ExpressionParser(text, names).parse();
}

template <class Scalar>
Scalar Expression::run(std::span<const Scalar> values) const {
  std::vector<Scalar> stack;
  for (const Instruction& at : code_) {
    if (at.operation == Number) {
      stack.emplace_back(at.number);
      continue;
    }
    if (at.operation == Name) {
      stack.push_back(values[static_cast<std::size_t>(at.name)]);
      continue;
    }
    const int count = arity(at.operation);
    const Scalar* operands = &stack[stack.size() - count];
    Scalar result =
        at.operation == Negate ? Scalar(-operands[0])
        : at.operation < FirstFunction
            ? apply_binary(at.operation, operands[0], operands[1])
            : apply_function(at.operation - FirstFunction, operands);
    if (!is_finite(result)) {
      not_finite(at.operation, operands, count, text_, at.column);
    }
    stack.resize(stack.size() - count);
    stack.push_back(std::move(result));
  }
  return stack.back();
}

double Expression::evaluate(std::span<const double> values) const {
  return run(values);
}

Dual Expression::evaluate(std::span<const Dual> values) const {
  return run(values);
}

std::vector<int> Expression::names_used() const {
  std::set<int> used;
  for (const Instruction& at : code_) {
    if (at.operation == Name) {
      used.insert(at.name);
    }
  }
  return {used.begin(), used.end()};
}

bool is_reserved_name(std::string_view name) {
  const auto is = [&](const auto& entry) { return name == entry.name; };
  return std::any_of(kConstants.begin(), kConstants.end(), is) ||
         std::any_of(kFunctions.begin(), kFunctions.end(), is);
}

std::string nearest_name(std::string_view name,
                         const std::vector<std::string>& known) {
  std::string best;
  std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string& candidate : known) {
    // Levenshtein's distance, one row at a time.
    std::vector<std::size_t> row(candidate.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) {
      row[j] = j;
    }
    for (std::size_t i = 0; i < name.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i + 1;
      for (std::size_t j = 0; j < candidate.size(); ++j) {
        const std::size_t change = diagonal + (name[i] == candidate[j] ? 0 : 1);
        diagonal = row[j + 1];
        row[j + 1] = std::min({change, row[j] + 1, row[j + 1] + 1});
      }
    }
    if (row.back() < least) {
      least = row.back();
      best = candidate;
    }
  }
  return best;
}

}  // namespace meniscus
