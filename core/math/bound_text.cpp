#include "core/math/bound_text.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/math/expression_code.h"

namespace meniscus {

namespace {

using expression_code::is_digit;
using expression_code::is_letter;

/// Past the number that starts at `at`, its exponent included: its e is no
/// name.
std::size_t skip_number(const std::string& text, std::size_t at) {
  const auto digits = [&] {
    while (at < text.size() && (is_digit(text[at]) || text[at] == '.')) {
      ++at;
    }
  };
  digits();
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    at += at < text.size() && (text[at] == '+' || text[at] == '-') ? 1 : 0;
    digits();
  }
  return at;
}

}  // namespace

std::string with_texts(const std::string& text,
                       const std::vector<std::string>& names,
                       const std::vector<std::string>& texts) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t start = at;
    if (is_digit(text[at]) || text[at] == '.') {
      at = skip_number(text, at);
    } else if (is_letter(text[at])) {
      while (at < text.size() && (is_letter(text[at]) || is_digit(text[at]))) {
        ++at;
      }
      auto name = names.end();
      if (at < text.size() && text[at] == '[') {  // an element of a vector
        const std::size_t close = std::min(text.find(']', at), text.size() - 1);
        name = std::find(names.begin(), names.end(),
                         text.substr(start, close + 1 - start));
        at = name == names.end() ? at : close + 1;
      }
      if (name == names.end()) {
        name = std::find(names.begin(), names.end(),
                         text.substr(start, at - start));
      }
      if (name != names.end()) {
        result += texts[static_cast<std::size_t>(name - names.begin())];
        continue;
      }
    } else {
      ++at;
    }
    result.append(text, start, at - start);
  }
  return result;
}

std::string with_values(const std::string& text,
                        const std::vector<std::string>& names,
                        std::span<const double> values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double value : values) {
    texts.push_back(fmt::format("({})", value));
  }
  return with_texts(text, names, texts);
}

}  // namespace meniscus
