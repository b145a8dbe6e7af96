#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/math/expression.h"
#include "core/math/expression_code.h"

namespace meniscus {

namespace {

using namespace expression_code;

constexpr int kDeepest = 200;
constexpr std::size_t kLongest = 10000;
constexpr std::size_t kShown = 80;  // characters of a text in a message

/// `known`: of a vector its elements, which count as its one name.
std::string suggestion(const std::string& word,
                       std::vector<std::string> known) {
  for (std::string& name : known) {
    name = name.substr(0, name.find('['));
  }
  const std::string near = nearest_name(word, known);
  return near.empty() ? "" : " (did you mean '" + near + "'?)";
}

/// The indices of the vector's last element; none where it has none.
std::vector<int> shape_of(const std::string& vector,
                          const std::vector<std::string>& names) {
  std::vector<int> shape;
  const auto last =
      std::find_if(names.rbegin(), names.rend(), [&](const auto& name) {
        return name.starts_with(vector) && name.size() > vector.size() &&
               name[vector.size()] == '[';
      });
  if (last != names.rend()) {
    const char* at = last->data() + vector.size();
    const char* end = last->data() + last->size();
    while (at < end && *at != ']') {
      at = std::from_chars(at + 1, end, shape.emplace_back()).ptr;
    }
  }
  return shape;
}

/// "t[i, j]".
std::string written(const std::string& vector, const std::vector<int>& shape) {
  const std::string letters = "i, j, k";
  return fmt::format("{}[{}]", vector, letters.substr(0, 3 * shape.size() - 2));
}

}  // namespace

/// Recursive descent into postfix code.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, const std::vector<std::string>& names,
                   std::span<const std::optional<double>> constants)
      : text_(text), names_(names), constants_(constants) {}

  /// What it made of a text, for others.
  static std::vector<Step> steps_of(const Expression& expression) {
    std::vector<Step> steps;
    for (const Expression::Instruction& at : expression.code_) {
      steps.push_back({at.operation, at.index, at.number, at.column});
    }
    return steps;
  }

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
      fail(text_[at_] == ')'
               ? "')' without its '('"
               : fmt::format("unexpected '{}'{}", here(),
                             text_[at_] == ',' ? " (decimals follow a point)"
                                               : unit_advice()));
    }
    return made();
  }

 private:
  Expression made() {
    Expression result;
    result.text_ = text_;
    result.code_ = std::exchange(code_, {});
    return result;
  }

  /// Where a number runs into a word: "59.3mm".
  std::string unit_advice() const {
    const std::string_view before = std::string_view(text_).substr(0, at_);
    double number = 0.0;
    const auto read =
        std::from_chars(before.data(), before.data() + before.size(), number);
    return read.ec == std::errc() &&
                   read.ptr == before.data() + before.size() &&
                   is_letter(text_[at_]) && text_.size() <= kShown
               ? fmt::format(
                     " (write '{0} {1}' for a unit, '{0}*{1}' for a "
                     "product)",
                     before, text_.substr(at_))
               : "";
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw ExpressionError(fmt::format("{} in '{}'", message, shown()),
                          static_cast<int>(at_) + 1);
  }
  std::string shown() const {
    return text_.size() <= kShown ? text_ : text_.substr(0, kShown - 3) + "...";
  }
  // The character at hand, whole when it is UTF-8 of several bytes.
  std::string here() const {
    if (at_ >= text_.size()) {
      return "end";
    }
    std::size_t size = 1;
    while (at_ + size < text_.size() &&
           (static_cast<unsigned char>(text_[at_ + size]) & 0xC0U) == 0x80U) {
      ++size;
    }
    return text_.substr(at_, size);
  }
  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) {
      ++at_;
    }
  }
  bool take(std::string_view token) {
    skip_space();
    if (text_.compare(at_, token.size(), token) != 0) {
      return false;
    }
    at_ += token.size();
    return true;
  }
  void emit(int operation, std::size_t column) {
    code_.push_back(
        {.operation = operation, .column = static_cast<int>(column) + 1});
  }
  void enter() {
    if (++depth_ > kDeepest) {
      fail(fmt::format("more than {} levels of nesting", kDeepest));
    }
  }

  void comparison() {
    enter();
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
      enter();
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
    if (error == std::errc::result_out_of_range) {
      fail("a number too large or too small to hold");
    }
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
    const std::string word = text_.substr(column, at_ - column);
    if (take("(")) {
      call(word, column);
      return;
    }
    const std::vector<int> shape = shape_of(word, names_);
    if (!shape.empty()) {
      element(word, shape, column);
      return;
    }
    const auto known = std::find(names_.begin(), names_.end(), word);
    if (known != names_.end()) {
      emit(Name, column);
      code_.back().index = static_cast<int>(known - names_.begin());
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

  // Its name stands in the text from here on, so that it says which one it is.
  void element(const std::string& word, const std::vector<int>& shape,
               std::size_t column) {
    if (!take("[")) {
      at_ = column;
      fail(
          fmt::format("'{}' has {} elements: write one of them, {}, counted "
                      "from 1 by numbers or the i, j, k of repeat,",
                      word, shape_text(shape), written(word, shape)));
    }
    std::vector<double> indices;
    do {
      indices.push_back(index(word, shape));
    } while (take(","));
    if (!take("]")) {
      fail(fmt::format("']' is missing before '{}'", here()));
    }
    const std::size_t end = std::exchange(at_, column);
    const std::string found =
        fmt::format("{}[{}]", word, fmt::join(indices, ","));
    if (indices.size() != shape.size()) {
      fail(fmt::format("{} has {} of {} indices: '{}' is {}, written {},",
                       found, indices.size(), shape.size(), word,
                       shape_text(shape), written(word, shape)));
    }
    for (std::size_t k = 0; k < shape.size(); ++k) {
      if (!(indices[k] >= 1.0 && indices[k] <= shape[k])) {
        fail(fmt::format("{} is not there: '{}' is {}, counted from 1,", found,
                         word, shape_text(shape)));
      }
    }
    const auto known = std::find(names_.begin(), names_.end(), found);
    emit(Name, column);
    code_.back().index = static_cast<int>(known - names_.begin());
    text_.replace(column, end - column, found);
    at_ = column + found.size();
  }

  double index(const std::string& word, const std::vector<int>& shape) {
    skip_space();
    const std::size_t start = at_;
    if (at_ < text_.size() && (text_[at_] == ']' || text_[at_] == ',')) {
      fail(fmt::format("an index is missing: '{}' is {}, written {},", word,
                       shape_text(shape), written(word, shape)));
    }
    std::vector<Expression::Instruction> before = std::exchange(code_, {});
    comparison();
    const Expression inner = made();
    code_ = std::move(before);
    std::vector<double> values;
    if (!inner.is_constant()) {
      values.resize(names_.size());
    }
    for (const int name : inner.names_used()) {
      const auto k = static_cast<std::size_t>(name);
      if (k >= constants_.size() || !constants_[k]) {
        at_ = start;
        fail(
            fmt::format("an index of '{}' depends on '{}', which moves or has "
                        "no value: '{}' is {}, its indices constant,",
                        word, names_[k], word, shape_text(shape)));
      }
      values[k] = *constants_[k];
    }
    const double value = inner.evaluate(values);
    if (value != std::floor(value)) {
      at_ = start;
      fail(
          fmt::format("the index {} of '{}' is not whole: '{}' is {}, counted "
                      "from 1,",
                      value, word, word, shape_text(shape)));
    }
    return value;
  }

  void call(const std::string& word, std::size_t column) {
    if (word == kConditional) {
      conditional(column);
      return;
    }
    const auto function =
        std::find_if(kFunctions.begin(), kFunctions.end(),
                     [&](const Function& f) { return word == f.name; });
    if (function == kFunctions.end()) {
      std::vector<std::string> known = {kConditional};
      for (const Function& f : kFunctions) {
        known.emplace_back(f.name);
      }
      at_ = column;
      fail("unknown function '" + word + "'" + suggestion(word, known));
    }
    for (int k = 0; k < function->arguments; ++k) {
      separate(k, word, function->arguments);
      comparison();
    }
    finish(word, function->arguments);
    emit(FirstFunction + static_cast<int>(function - kFunctions.begin()),
         column);
  }

  // condition, jump if zero to A, then, jump to B, A: else, B:
  void conditional(std::size_t column) {
    constexpr int kArguments = 3;
    comparison();
    separate(1, kConditional, kArguments);
    const std::size_t to_else = code_.size();
    emit(JumpIfZero, column);
    comparison();
    separate(2, kConditional, kArguments);
    const std::size_t to_end = code_.size();
    emit(Jump, column);
    code_[to_else].index = static_cast<int>(code_.size());
    comparison();
    code_[to_end].index = static_cast<int>(code_.size());
    finish(kConditional, kArguments);
  }

  void separate(int argument, const std::string& word, int count) {
    if (argument > 0 && !take(",")) {
      fail(fmt::format("{} takes {} arguments, ',' is missing", word, count));
    }
  }

  void finish(const std::string& word, int count) {
    if (take(",")) {
      fail(fmt::format("{} takes {} argument{}", word, count,
                       count == 1 ? "" : "s"));
    }
    close();
  }

  std::string text_;
  const std::vector<std::string>& names_;
  std::span<const std::optional<double>> constants_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<Expression::Instruction> code_;
};

Expression Expression::parse(std::string_view text,
                             const std::vector<std::string>& names,
                             std::span<const std::optional<double>> constants) {
  return ExpressionParser(text, names, constants).parse();
}

Measure measure_of(const Expression& expression,
                   std::span<const Measure> names) {
  return measure_steps(ExpressionParser::steps_of(expression),
                       expression.text(), names);
}

}  // namespace meniscus
