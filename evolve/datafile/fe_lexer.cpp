#include "evolve/datafile/fe_lexer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::datafile {

namespace {

constexpr std::size_t kLongestMacro = 10000;   // tokens of one definition
constexpr std::size_t kDeepestMacro = 200;     // uses within uses
constexpr std::size_t kMacroTokens = 1000000;  // + one per character of text
constexpr std::size_t kLongestName = 200;
constexpr std::size_t kLongestNumber = 400;
constexpr std::size_t kShown = 40;  // characters of a token in a message

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
// Ctrl-Z ends files from DOS.
bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\f' || c == '\v' || c == '\x1a';
}
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

std::string printable(std::string_view text) {
  std::string shown;
  for (const char c : text.substr(0, kShown)) {
    const auto byte = static_cast<unsigned char>(c);
    shown += byte < 0x20U || byte >= 0x7fU ? fmt::format("\\x{:02x}", byte)
                                           : std::string(1, c);
  }
  return text.size() > kShown ? shown + "..." : shown;
}

}  // namespace

FeLexer::FeLexer(std::string_view text, std::string name, int first_line)
    : text_(text), name_(std::move(name)), line_(first_line) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    text_.remove_prefix(kByteOrderMark.size());
  }
  advance();
}

FeToken FeLexer::take() {
  FeToken token = std::move(token_);
  advance();
  return token;
}

std::string_view FeLexer::rest() const {
  return frames_.empty() ? text_.substr(at_) : std::string_view();
}

void FeLexer::fail(const FePlace& place, const std::string& what) const {
  throw InvalidInput(
      fmt::format("{}:{}:{}: {}", name_, place.line, place.column, what));
}

void FeLexer::fail_here(const std::string& what) const {
  const std::string found = token_.kind == FeToken::Kind::End
                                ? "the end of the file"
                                : "'" + printable(token_.text) + "'";
  fail(token_.place, what + ", found " + found);
}

FePlace FeLexer::here() const {
  return {line_, static_cast<int>(at_ - line_start_) + 1};
}

void FeLexer::newline() {
  at_ += at(0) == '\r' && at(1) == '\n' ? 2 : 1;
  line_start_ = at_;
  ++line_;
}

void FeLexer::skip_block_comment() {
  const FePlace start = here();
  at_ += 2;
  while (at_ < text_.size() && !(at(0) == '*' && at(1) == '/')) {
    if (is_line_end(at(0))) {
      newline();
      new_line_ = true;
    } else {
      ++at_;
    }
  }
  if (at_ >= text_.size()) {
    fail(start, "the comment that starts here has no end; close it with */");
  }
  at_ += 2;
}

bool FeLexer::skip_splice() {
  std::size_t end = 1;
  while (is_blank(at(end))) {
    ++end;
  }
  if (!is_line_end(at(end))) {
    return false;
  }
  at_ += end;
  newline();
  return true;
}

void FeLexer::skip_space(bool within_line) {
  space_ = false;
  while (at_ < text_.size()) {
    const char c = at(0);
    if (is_blank(c)) {
      ++at_;
    } else if (is_line_end(c)) {
      if (within_line) {
        return;
      }
      newline();
      new_line_ = true;
    } else if (c == '/' && at(1) == '/') {
      while (at_ < text_.size() && !is_line_end(at(0))) {
        ++at_;
      }
    } else if (c == '/' && at(1) == '*') {
      skip_block_comment();
    } else if (c != '\\' || !skip_splice()) {
      return;
    }
    space_ = true;
  }
}

std::string_view FeLexer::word() {
  const std::size_t start = at_;
  while (is_letter(at(0)) || is_digit(at(0))) {
    ++at_;
  }
  return text_.substr(start, at_ - start);
}

void FeLexer::advance() {
  if (from_macro(token_)) {
    return;
  }
  for (;;) {
    skip_space(false);
    token_ = raw();
    if (token_.kind == FeToken::Kind::Symbol && token_.text == "#") {
      directive(token_.place);
      continue;
    }
    if (token_.kind != FeToken::Kind::Name || !expand(token_)) {
      return;
    }
    if (from_macro(token_)) {
      return;
    }
  }
}

// The next token of the macros in use, spaces and place as at the outermost
// use.
bool FeLexer::from_macro(FeToken& token) {
  while (!frames_.empty()) {
    Frame& frame = frames_.back();
    if (frame.next == frame.tokens->size()) {
      frames_.pop_back();
      continue;
    }
    if (++expanded_ > kMacroTokens + text_.size()) {
      fail(token.place, fmt::format("macros expand to more than {} tokens here",
                                    kMacroTokens + text_.size()));
    }
    FeToken next = (*frame.tokens)[frame.next];
    const bool leads = frame.next == 0;
    ++frame.next;
    if (leads) {
      next.first_on_line = token.first_on_line;
      next.after_space = token.after_space;
    }
    next.place = token.place;
    if (next.kind == FeToken::Kind::Name) {
      spelling_ = next.text;
      if (expand(next)) {
        token = std::move(next);
        continue;
      }
      std::transform(next.text.begin(), next.text.end(), next.text.begin(),
                     lower_case);
    }
    token = std::move(next);
    return true;
  }
  return false;
}

bool FeLexer::expand(const FeToken& token) {
  if (macros_.empty()) {
    return false;
  }
  const auto found = macros_.find(spelling_);
  if (found == macros_.end()) {
    return false;
  }
  for (const Frame& frame : frames_) {
    if (frame.macro == spelling_) {
      fail(token.place, fmt::format("macro '{}' contains itself", spelling_));
    }
  }
  if (frames_.size() >= kDeepestMacro) {
    fail(token.place,
         fmt::format("macros are nested more than {} deep", kDeepestMacro));
  }
  frames_.push_back({&found->second, 0, spelling_});
  return true;
}

// Behind skip_space().
FeToken FeLexer::raw() {
  FeToken token;
  token.place = here();
  token.first_on_line = new_line_;
  token.after_space = space_ || new_line_;
  new_line_ = false;
  const char c = at(0);
  if (at_ >= text_.size()) {
    token.first_on_line = true;
    return token;
  }
  if (is_digit(c) || (c == '.' && is_digit(at(1)))) {
    number(token);
  } else if (is_letter(c)) {
    spelling_ = word();
    if (spelling_.size() > kLongestName) {
      fail(token.place, fmt::format("a name of {} letters; at most {} are read",
                                    spelling_.size(), kLongestName));
    }
    token.kind = FeToken::Kind::Name;
    token.text = spelling_;
    token.upper = lower_case(spelling_.front()) != spelling_.front();
    std::transform(token.text.begin(), token.text.end(), token.text.begin(),
                   lower_case);
  } else if (c == '"') {
    quoted(token);
  } else {
    symbol(token);
  }
  token.before_space = at_ >= text_.size() || is_blank(at(0)) ||
                       is_line_end(at(0)) ||
                       (at(0) == '/' && (at(1) == '/' || at(1) == '*'));
  return token;
}

// #define NAME tokens to the end of the line.
void FeLexer::directive(const FePlace& place) {
  const std::string what(word());
  std::string key = what;
  std::transform(key.begin(), key.end(), key.begin(), lower_case);
  if (key != "define") {
    fail(place, fmt::format("'#{}' is not supported; only #define is. Paste "
                            "included files in",
                            printable(what)));
  }
  skip_space(true);
  const std::string macro(word());
  if (macro.empty() || is_digit(macro.front()) || macro.size() > kLongestName) {
    fail(place, "#define needs a name: '#define NAME text'");
  }
  std::vector<FeToken> body;
  for (;;) {
    skip_space(true);
    if (at_ >= text_.size() || is_line_end(at(0))) {
      break;
    }
    FeToken token = raw();
    token.first_on_line = false;
    if (token.kind == FeToken::Kind::Name) {
      token.text = spelling_;
    }
    body.push_back(std::move(token));
    if (body.size() > kLongestMacro) {
      fail(place, fmt::format("macro '{}' has more than {} tokens", macro,
                              kLongestMacro));
    }
  }
  macros_[macro] = std::move(body);
}

void FeLexer::number(FeToken& token) {
  const std::size_t start = at_;
  const bool hexadecimal = at(0) == '0' && lower_case(at(1)) == 'x';
  while (is_digit(at(0)) || is_letter(at(0)) || at(0) == '.' ||
         (!hexadecimal && (at(0) == '+' || at(0) == '-') &&
          (lower_case(text_[at_ - 1]) == 'e' ||
           lower_case(text_[at_ - 1]) == 'd') &&
          is_digit(at(1)))) {
    ++at_;
  }
  std::string digits(text_.substr(start, at_ - start));
  token.kind = FeToken::Kind::Number;
  token.text = digits;
  if (digits.size() > kLongestNumber) {
    fail(token.place, fmt::format("a number of {} characters; at most {} are "
                                  "read",
                                  digits.size(), kLongestNumber));
  }
  const bool binary = digits.size() > 1 && lower_case(digits.back()) == 'b' &&
                      digits.find_first_not_of("01") == digits.size() - 1;
  bool good = false;
  if (hexadecimal || binary) {
    const char* first = digits.data() + (hexadecimal ? 2 : 0);
    const char* last = digits.data() + digits.size() - (binary ? 1 : 0);
    unsigned long value = 0;
    const auto [end, error] =
        std::from_chars(first, last, value, hexadecimal ? 16 : 2);
    good = error == std::errc() && end == last;
    token.number = static_cast<double>(value);
  } else {
    for (char& c : digits) {
      c = lower_case(c) == 'd' ? 'e' : c;
    }
    const char* last = digits.data() + digits.size();
    const auto [end, error] =
        std::from_chars(digits.data(), last, token.number);
    good = error == std::errc() && end == last && std::isfinite(token.number);
  }
  if (!good) {
    fail(token.place, fmt::format("'{}' is no number, or out of range",
                                  printable(token.text)));
  }
}

void FeLexer::quoted(FeToken& token) {
  const std::size_t start = ++at_;
  while (at_ < text_.size() && at(0) != '"' && !is_line_end(at(0))) {
    ++at_;
  }
  if (at(0) != '"') {
    fail(token.place, "the text that starts here has no closing quote");
  }
  token.kind = FeToken::Kind::String;
  token.text = text_.substr(start, at_ - start);
  ++at_;
}

void FeLexer::symbol(FeToken& token) {
  static constexpr std::array<std::string_view, 7> kPairs = {
      "**", "==", "!=", "<=", ">=", "&&", "||"};
  static constexpr std::string_view kSingle = "+-*/^()[]{}=<>!?:,;%.#";
  token.kind = FeToken::Kind::Symbol;
  const std::string_view pair = text_.substr(at_, 2);
  if (std::find(kPairs.begin(), kPairs.end(), pair) != kPairs.end()) {
    token.text = pair;
    at_ += 2;
    return;
  }
  if (kSingle.find(at(0)) == std::string_view::npos) {
    fail(token.place, fmt::format("unexpected character '{}'",
                                  printable(text_.substr(at_, 1))));
  }
  token.text = std::string(1, at(0));
  ++at_;
}

}  // namespace meniscus::datafile
