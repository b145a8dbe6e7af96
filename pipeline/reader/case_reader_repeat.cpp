#include "pipeline/reader/case_reader_repeat.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::reader {

namespace {

constexpr int kMostCount = 1000;
constexpr std::size_t kMostCopies = 4000;
constexpr std::int64_t kMostValue = 1000000000;
const std::vector<std::string> kLetters = {"i", "j", "k"};

/// Whole-number arithmetic within braces. Throws InvalidInput.
class Arithmetic {
 public:
  Arithmetic(const CaseContext& context, const std::vector<int>& indices,
             const std::string& text)
      : context_(context), indices_(indices), text_(text) {}

  std::int64_t value() {
    const std::int64_t result = sum();
    skip();
    if (at_ < text_.size()) {
      refuse(fmt::format("found '{}'", text_.substr(at_)));
    }
    return result;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InvalidInput(fmt::format(
        "{} in '{{{}}}'; expected whole numbers, i, j, k, + - * / % and "
        "brackets",
        what, text_));
  }
  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') {
      ++at_;
    }
  }
  bool accept(char c) {
    skip();
    const bool found = at_ < text_.size() && text_[at_] == c;
    at_ += found ? 1 : 0;
    return found;
  }
  std::int64_t checked(std::int64_t value) const {
    if (std::abs(value) > kMostValue) {
      refuse("too large a number");
    }
    return value;
  }
  std::int64_t sum() {
    std::int64_t result = product();
    for (;;) {
      if (accept('+')) {
        result = checked(result + product());
      } else if (accept('-')) {
        result = checked(result - product());
      } else {
        return result;
      }
    }
  }
  std::int64_t product() {
    std::int64_t result = factor();
    for (;;) {
      if (accept('*')) {
        result = checked(result * factor());
        continue;
      }
      const bool over = accept('/');
      if (!over && !accept('%')) {
        return result;
      }
      const std::int64_t by = factor();
      if (by == 0) {
        refuse("a division by 0");
      }
      std::int64_t rest = result % by;
      rest += rest != 0 && (rest < 0) != (by < 0) ? by : 0;
      if (over && rest != 0) {
        refuse(fmt::format("{} / {}, which is no whole number,", result, by));
      }
      result = over ? result / by : rest;
    }
  }
  std::int64_t factor() {
    if (accept('-')) {
      return -factor();
    }
    if (accept('(')) {
      const std::int64_t result = sum();
      if (!accept(')')) {
        refuse("a bracket that is never closed");
      }
      return result;
    }
    skip();
    const std::size_t start = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 ||
            text_[at_] == '_')) {
      ++at_;
    }
    return value_of(text_.substr(start, at_ - start));
  }
  std::int64_t value_of(const std::string& word) const {
    if (word.empty()) {
      refuse("no number");
    }
    if (std::isdigit(static_cast<unsigned char>(word[0])) != 0) {
      std::int64_t number = 0;
      for (const char c : word) {
        if (std::isdigit(static_cast<unsigned char>(c)) == 0) {
          refuse(fmt::format("'{}'", word));
        }
        number = checked(10 * number + (c - '0'));
      }
      return number;
    }
    for (std::size_t k = 0; k < indices_.size(); ++k) {
      if (word == kLetters[k]) {
        return indices_[k];
      }
    }
    const auto name =
        std::find(context_.names.begin(), context_.names.end(), word);
    const auto k = static_cast<std::size_t>(name - context_.names.begin());
    if (k >= context_.constants.size() || !context_.constants[k]) {
      refuse(fmt::format("'{}', which has no constant value,", word));
    }
    const double value = *context_.constants[k];
    if (value != std::floor(value) || std::abs(value) > kMostValue) {
      refuse(fmt::format("{} = {:g}, which is no whole number,", word, value));
    }
    return static_cast<std::int64_t>(value);
  }

  const CaseContext& context_;
  const std::vector<int>& indices_;
  const std::string& text_;
  std::size_t at_ = 0;
};

std::optional<int> read_count(CaseContext& context, const toml::node& node,
                              const std::string& path) {
  std::optional<double> value;
  if (node.is_string()) {
    value = read_constant(context, node, Dimension::None, path);
    if (!value) {
      return std::nullopt;  // noted
    }
  } else if (const auto number = node.value_exact<std::int64_t>()) {
    value = static_cast<double>(*number);
  }
  if (!value || *value != std::floor(*value) || *value < 1.0 ||
      *value > kMostCount) {
    context.problems.add(
        context.line_of(node),
        fmt::format("{} is {}; expected a whole number from 1 to {}, or two or "
                    "three: [8, 4]",
                    path,
                    node.is_string() && value ? fmt::format("{:g}", *value)
                                              : described(node),
                    kMostCount));
    return std::nullopt;
  }
  return static_cast<int>(*value);
}

}  // namespace

std::vector<int> read_counts(CaseContext& context, const toml::node& node,
                             const std::string& path) {
  std::vector<int> counts;
  const toml::array* array = node.as_array();
  const std::size_t wanted = array == nullptr ? 1 : array->size();
  if (wanted < 1 || wanted > kLetters.size()) {
    context.problems.add(context.line_of(node),
                         fmt::format("{} is {}; expected one to three whole "
                                     "numbers: 12 or [8, 4]",
                                     path, described(node)));
    return {};
  }
  for (std::size_t k = 0; k < wanted; ++k) {
    const auto count =
        read_count(context, array == nullptr ? node : (*array)[k], path);
    if (!count) {
      return {};
    }
    counts.push_back(*count);
  }
  return counts;
}

std::vector<std::vector<int>> copies_of(CaseContext& context,
                                        const toml::node& node,
                                        const std::string& path,
                                        const std::vector<int>& counts,
                                        const std::vector<int>& before) {
  std::vector<std::vector<int>> copies = {before};
  if (before.size() + counts.size() > kLetters.size()) {
    context.problems.add(
        context.line_of(node),
        fmt::format("{} counts in {} directions with what it stands in; there "
                    "are i, j and k",
                    path, before.size() + counts.size()));
    return copies;
  }
  for (std::size_t axis = 0; axis < counts.size(); ++axis) {
    const std::string& letter = kLetters[before.size() + axis];
    if (std::any_of(context.names.begin(), context.names.end(),
                    [&](const std::string& name) {
                      return name.substr(0, name.find('[')) == letter;
                    })) {
      context.problems.add(
          context.line_of(node),
          fmt::format("{} counts with {}, which is also a parameter or design "
                      "variable; give that another name",
                      path, letter));
    }
    std::vector<std::vector<int>> more;
    for (const std::vector<int>& copy : copies) {
      for (int index = 1; index <= counts[axis]; ++index) {
        more.push_back(copy);
        more.back().push_back(index);
      }
    }
    copies = std::move(more);
    if (copies.size() > kMostCopies) {
      context.problems.add(context.line_of(node),
                           fmt::format("{} makes {} copies or more; at most {} "
                                       "are taken",
                                       path, copies.size(), kMostCopies));
      copies.resize(1);
      copies[0].resize(before.size() + counts.size(), 1);
      return copies;
    }
  }
  return copies;
}

std::string filled(CaseContext& context, const std::string& text,
                   const std::vector<int>& indices, case_data::SourceLine line,
                   const std::string& path) {
  std::string result;
  std::size_t at = 0;
  while (!indices.empty()) {
    const std::size_t open = text.find('{', at);
    if (open == std::string::npos) {
      break;
    }
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) {
      context.problems.add(
          line,
          fmt::format("{}: '{}' has a '{{' that is never closed", path, text));
      return text;
    }
    result.append(text, at, open - at);
    const std::string inner = text.substr(open + 1, close - open - 1);
    try {
      result += fmt::format("{}", Arithmetic(context, indices, inner).value());
    } catch (const InvalidInput& error) {
      context.problems.add(line, fmt::format("{}: {}", path, error.what()));
      return text;
    }
    at = close + 1;
  }
  result.append(text, at);
  return result;
}

}  // namespace meniscus::reader
