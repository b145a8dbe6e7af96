#include "evolve/fe_script.h"

#include <cmath>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <functional>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/fe_lexer.h"
#include "evolve/fe_session.h"

namespace meniscus {

namespace {

constexpr int kMostNesting = 60;
constexpr std::size_t kMostTokens = 2'000'000;

using Kind = FeSession::Kind;

struct Range {
  std::size_t first = 0;
  std::size_t last = 0;  // behind the last token
};

/// Commands that only show something.
bool is_view(const std::string& word) {
  static const char* const kViews[] = {
      "show", "s", "q", "show_trans", "transforms", "transform_expr", "view",
      "autodisplay", "quiet", "clipped", "raw_cells", "connected", "background"};
  return std::find(std::begin(kViews), std::end(kViews), word) !=
         std::end(kViews);
}

bool is_color(const std::string& word) {
  return word == "color" || word == "frontcolor" || word == "backcolor" ||
         word == "colour" || word == "opacity" || word == "nodisplay";
}

/// Walks the tokens and runs what they say. Blocks are run anew each time:
/// simple, and quick beside the films.
class Runner {
 public:
  Runner(const FeFile& file, FeSession& session, const FeScriptOptions& options)
      : file_(file), session_(session), options_(options) {
    FeLexer lexer(file.commands, file.name);
    while (lexer.peek().kind != FeToken::Kind::End) {
      if (tokens_.size() == kMostTokens) {
        lexer.fail_here("the read section has too many words");
      }
      tokens_.push_back(lexer.take());
    }
    FeToken end;
    end.place = lexer.peek().place;
    tokens_.push_back(end);
    std::size_t start = 0;
    line_start_.push_back(0);
    while ((start = file.commands.find('\n', start)) != std::string::npos) {
      line_start_.push_back(++start);
    }
  }

  void run_all() {
    at_ = 0;
    commands(tokens_.size() - 1);
  }

  void run_macro(const std::string& name) {
    const auto found = macros_.find(name);
    if (found == macros_.end()) {
      std::string known;
      for (const auto& [other, range] : macros_) {
        known += (known.empty() ? "" : ", ") + other;
      }
      throw InvalidInput(fmt::format(
          "{}: the file has no macro '{}'; it has: {}", file_.name, name,
          known.empty() ? "none" : known));
    }
    call(found->second);
  }

  std::string output;

 private:
  struct Element {
    Kind kind = Kind::Vertex;
    int index = -1;
  };

  const FeToken& peek(std::size_t ahead = 0) const {
    return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
  }
  const FeToken& take() { return tokens_[at_ + 1 < tokens_.size() ? at_++ : at_]; }
  bool accept(std::string_view symbol) {
    if (peek().is(symbol)) {
      take();
      return true;
    }
    return false;
  }
  bool accept_name(std::string_view name) {
    if (peek().is_name(name)) {
      take();
      return true;
    }
    return false;
  }
  [[noreturn]] void fail(const FeToken& token, const std::string& what) const {
    throw InvalidInput(fmt::format("{}:{}:{}: {}, found '{}'", file_.name,
                                   file_.commands_line + token.place.line - 1,
                                   token.place.column, what, token.text));
  }
  void expect(std::string_view symbol) {
    if (!accept(symbol)) {
      fail(peek(), fmt::format("expected '{}'", symbol));
    }
  }
  /// A name as it was written: one-letter commands heed case.
  std::string spelled(const FeToken& token) const {
    const auto line = static_cast<std::size_t>(token.place.line - 1);
    if (line >= line_start_.size()) {
      return token.text;
    }
    return file_.commands.substr(
        line_start_[line] + static_cast<std::size_t>(token.place.column - 1),
        token.text.size());
  }
  void count_step() {
    if (++steps_ > options_.most_steps) {
      fail(peek(), "the macro does not end: too many commands");
    }
    if (options_.monitor != nullptr) {
      throw_if_stopped(*options_.monitor, "film");
    }
  }

  void call(const Range& range) {
    if (++depth_ > kMostNesting) {
      fail(peek(), "macros call each other without end");
    }
    const std::size_t back = at_;
    at_ = range.first;
    commands(range.last);
    at_ = back;
    --depth_;
  }

  void commands(std::size_t last) {
    while (at_ < last) {
      if (!accept(";")) {
        command();
      }
    }
  }

  /// Moves past one command without running it.
  Range skip_command() {
    const Range whole{at_, 0};
    const bool live = live_;
    live_ = false;
    command();
    live_ = live;
    return {whole.first, at_};
  }

  void rerun(const Range& range) {
    const std::size_t back = at_;
    at_ = range.first;
    commands(range.last);
    at_ = back;
  }

  void block() {
    const FeToken open = take();
    if (++nesting_ > kMostNesting) {
      fail(open, "blocks nest too deep");
    }
    const std::size_t first = at_;
    // The end is found first: a block may be repeated.
    int level = 1;
    std::size_t end = at_;
    for (; level > 0; ++end) {
      if (end + 1 >= tokens_.size()) {
        fail(open, "this block has no end");
      }
      level += tokens_[end].is("{") ? 1 : tokens_[end].is("}") ? -1 : 0;
    }
    const Range inside{first, end - 1};
    at_ = end;
    int times = 1;
    if (peek().kind == FeToken::Kind::Number) {
      times = static_cast<int>(take().number);
    }
    for (int k = 0; k < times && live_; ++k) {
      count_step();
      rerun(inside);
    }
    --nesting_;
  }

  void command() {
    count_step();
    if (peek().is("{")) {
      block();
      return;
    }
    const FeToken token = peek();
    if (token.kind != FeToken::Kind::Name) {
      fail(token, "expected a command");
    }
    if (definition()) {
      return;
    }
    if (token.text == "if") {
      branch();
    } else if (token.text == "while" || token.text == "do" ||
               token.text == "for") {
      loop();
    } else if (token.text == "set" || token.text == "unset" ||
               token.text == "fix" || token.text == "unfix") {
      set_command();
    } else if (token.text == "refine") {
      refine_command();
    } else if (token.text == "printf") {
      print();
    } else if (is_view(token.text)) {
      take();
      while (!peek().is(";") && !peek().is("}") && !peek().first_on_line &&
             peek().kind != FeToken::Kind::End) {
        take();
      }
    } else {
      plain_command();
    }
  }

  /// name := ..., name += ..., body[1].target := ...
  bool definition() {
    const FeToken token = peek();
    if (token.is_name("body") && peek(1).is("[")) {
      const std::size_t start = at_;
      take();
      const Element element = element_of(Kind::Body);
      if (accept(".")) {
        const FeToken what = take();
        if (assigns(peek())) {
          assign_attribute(element, what);
          return true;
        }
      }
      at_ = start;
      return false;
    }
    const FeToken& sign = peek(1);
    if (!assigns(sign)) {
      return false;
    }
    take();
    take();
    if (sign.text == ":=" && peek().is("{")) {
      const std::size_t first = at_;
      skip_command();
      if (live_) {
        macros_[token.text] = {first, at_};
      }
      return true;
    }
    if (sign.text == ":=" && starts_command()) {
      const Range range = skip_command();
      if (live_) {
        macros_[token.text] = range;
      }
      return true;
    }
    const double right = expression();
    if (live_) {
      const double left = sign.text == ":=" ? 0.0 : variable(token);
      session_.assign(token.text, combined(sign.text, left, right));
    }
    return true;
  }

  static bool assigns(const FeToken& token) {
    return token.is(":=") || token.is("+=") || token.is("-=") ||
           token.is("*=") || token.is("/=");
  }
  static double combined(const std::string& sign, double left, double right) {
    switch (sign[0]) {
      case '+':
        return left + right;
      case '-':
        return left - right;
      case '*':
        return left * right;
      case '/':
        return left / right;
      default:
        return right;
    }
  }
  /// Is what follows := a command and no expression?
  bool starts_command() const {
    static const char* const kWords[] = {"set",  "unset",  "refine", "printf",
                                         "fix",  "unfix",  "if",     "for",
                                         "while", "do",    "show",   "transform_expr",
                                         "transforms"};
    return peek().kind == FeToken::Kind::Name &&
           std::find(std::begin(kWords), std::end(kWords), peek().text) !=
               std::end(kWords);
  }

  double variable(const FeToken& token) const {
    if (!session_.has_name(token.text)) {
      fail(token, "a name that has no value");
    }
    return session_.value(token.text);
  }

  void assign_attribute(const Element& element, const FeToken& what) {
    const std::string sign = take().text;
    const double right = expression();
    if (!live_) {
      return;
    }
    double left = 0.0;
    session_.attribute(element.kind, element.index, what.text, 0, left);
    if (!session_.set_attribute(element.kind, element.index, what.text,
                                combined(sign, left, right))) {
      fail(what, "an attribute that cannot be set");
    }
  }

  void branch() {
    take();
    const bool holds = expression() != 0.0;
    if (!accept_name("then")) {
      fail(peek(), "expected 'then'");
    }
    const bool live = live_;
    live_ = live && holds;
    command();
    live_ = live;
    // "else" may stand behind a semicolon? Only directly, as in Evolver.
    if (accept_name("else")) {
      live_ = live && !holds;
      command();
      live_ = live;
    }
  }

  void loop() {
    const FeToken word = take();
    if (word.text == "do") {
      const Range body = skip_command();
      if (!accept_name("while")) {
        fail(peek(), "expected 'while'");
      }
      const std::size_t condition = at_;
      skip_expression();
      const std::size_t end = at_;
      if (live_) {
        do {
          count_step();
          rerun(body);
          at_ = condition;
        } while (expression() != 0.0);
      }
      at_ = end;
      return;
    }
    Range start;
    Range step;
    if (word.text == "for") {
      expect("(");
      start = skip_command();
      expect(";");
    }
    const std::size_t condition = at_;
    skip_expression();
    if (word.text == "for") {
      expect(";");
      step = skip_command();
      expect(")");
    } else if (!accept_name("do")) {
      fail(peek(), "expected 'do'");
    }
    const Range body = skip_command();
    const std::size_t end = at_;
    if (live_) {
      rerun(start);
      const auto holds = [&] {
        at_ = condition;
        return expression() != 0.0;
      };
      while (holds()) {
        count_step();
        rerun(body);
        rerun(step);
      }
    }
    at_ = end;
  }

  Kind kind_of(const FeToken& token) const {
    const std::string& t = token.text;
    if (t == "vertex" || t == "vertices") {
      return Kind::Vertex;
    }
    if (t == "edge" || t == "edges") {
      return Kind::Edge;
    }
    if (t == "facet" || t == "facets" || t == "face" || t == "faces") {
      return Kind::Facet;
    }
    if (t == "body" || t == "bodies") {
      return Kind::Body;
    }
    fail(token, "expected vertices, edges, facets or bodies");
  }

  Element element_of(Kind kind) {
    expect("[");
    const FeToken where = peek();
    const auto id = static_cast<int>(expression());
    expect("]");
    int index = kind == Kind::Body ? session_.body_of(id) : id - 1;
    if (live_ && (index < 0 || index >= session_.count(kind))) {
      fail(where, fmt::format("there is no element {}", id));
    }
    return {kind, index};
  }

  /// `where` condition at hand as a filter; all elements without one.
  FeSession::Filter filter(Kind kind, std::size_t& end) {
    if (!accept_name("where")) {
      end = at_;
      return [](int) { return true; };
    }
    const std::size_t condition = at_;
    skip_expression();
    end = at_;
    return [this, kind, condition](int index) {
      const std::size_t back = at_;
      const Element before = element_;
      at_ = condition;
      element_ = {kind, index};
      const bool holds = expression() != 0.0;
      element_ = before;
      at_ = back;
      return holds;
    };
  }

  void for_elements(Kind kind, const FeSession::Filter& chosen,
                    const std::function<void(int)>& work) {
    std::vector<int> found;
    for (int k = 0; k < session_.count(kind) && live_; ++k) {
      if (chosen(k)) {
        found.push_back(k);
      }
    }
    for (auto k = found.rbegin(); k != found.rend(); ++k) {
      work(*k);
    }
  }

  void set_command() {
    const FeToken word = take();
    const bool on = word.text == "set" || word.text == "fix";
    const Kind kind = kind_of(take());
    std::size_t end = at_;
    if (word.text == "fix" || word.text == "unfix") {
      const FeSession::Filter chosen = filter(kind, end);
      apply_mark(kind, chosen, word, "fixed", 0, on);
      at_ = end;
      return;
    }
    const FeToken what = take();
    if (is_color(what.text)) {
      if (peek().kind == FeToken::Kind::Name && !peek().is_name("where")) {
        take();
      } else if (!peek().is_name("where")) {
        skip_expression();
      }
      filter(kind, end);
      at_ = end;
      return;
    }
    if (!on || what.text == "fixed") {
      int number = 0;
      if (what.text == "constraint" || what.text == "boundary") {
        number = static_cast<int>(expression());
      }
      const FeSession::Filter chosen = filter(kind, end);
      apply_mark(kind, chosen, what, what.text, number, on);
      at_ = end;
      return;
    }
    const std::size_t value = at_;
    skip_expression();
    const FeSession::Filter chosen = filter(kind, end);
    for_elements(kind, chosen, [&](int index) {
      at_ = value;
      const Element before = element_;
      element_ = {kind, index};
      const double right = expression();
      element_ = before;
      if (!session_.set_attribute(kind, index, what.text, right)) {
        fail(what, "an attribute that cannot be set");
      }
    });
    at_ = end;
  }

  void apply_mark(Kind kind, const FeSession::Filter& chosen,
                  const FeToken& where, const std::string& name, int number,
                  bool on) {
    for_elements(kind, chosen, [&](int index) {
      if (!session_.mark(kind, index, name, number, on)) {
        fail(where, "an attribute that cannot be changed here");
      }
    });
  }

  void refine_command() {
    take();
    const FeToken what = peek();
    if (kind_of(take()) != Kind::Edge) {
      fail(what, "only edges can be refined one by one");
    }
    std::size_t end = at_;
    const FeSession::Filter chosen = filter(Kind::Edge, end);
    if (live_) {
      session_.refine_edges(chosen);
    }
    at_ = end;
  }

  void print() {
    take();
    const FeToken format = take();
    if (format.kind != FeToken::Kind::String) {
      fail(format, "expected a format text");
    }
    std::vector<double> values;
    while (accept(",")) {
      values.push_back(expression());
    }
    if (live_) {
      output += printed(format, values);
    }
  }

  std::string printed(const FeToken& format, const std::vector<double>& values) {
    std::string result;
    std::size_t next = 0;
    const std::string& text = format.text;
    for (std::size_t k = 0; k < text.size(); ++k) {
      if (text[k] == '\\' && k + 1 < text.size()) {
        ++k;
        result += text[k] == 'n' ? '\n' : text[k] == 't' ? '\t' : text[k];
        continue;
      }
      if (text[k] != '%') {
        result += text[k];
        continue;
      }
      std::size_t end = k + 1;
      if (end < text.size() && text[end] == '%') {
        result += '%';
        k = end;
        continue;
      }
      while (end < text.size() && std::strchr("+- #0123456789.l", text[end])) {
        ++end;
      }
      if (end >= text.size() || !std::strchr("difgeFGE", text[end]) ||
          end - k > 16) {
        fail(format, "a format that prints no number");
      }
      if (next == values.size()) {
        fail(format, "more formats than values");
      }
      std::string spec = text.substr(k, end - k);
      spec.erase(std::remove(spec.begin(), spec.end(), 'l'), spec.end());
      const bool whole = text[end] == 'd' || text[end] == 'i';
      std::array<char, 512> buffer{};
      const double value = values[next++];
      if (whole) {
        spec += ".0f";
        std::snprintf(buffer.data(), buffer.size(), spec.c_str(), value);
      } else {
        spec += text[end];
        std::snprintf(buffer.data(), buffer.size(), spec.c_str(), value);
      }
      result += buffer.data();
      k = end;
    }
    return result;
  }

  /// A number behind a command, or `otherwise`.
  double count_behind(double otherwise) {
    if (peek().kind == FeToken::Kind::Number && !peek().first_on_line) {
      return take().number;
    }
    return otherwise;
  }

  void plain_command() {
    const FeToken token = take();
    const std::string word = token.text.size() == 1 ? spelled(token) : token.text;
    const auto repeat = [&](const auto& work) {
      const auto times = static_cast<int>(count_behind(1.0));
      for (int k = 0; k < times && live_; ++k) {
        count_step();
        work();
      }
    };
    if (word == "g") {
      const auto count = static_cast<int>(count_behind(1.0));
      if (live_) {
        session_.descend_steps(count);
      }
    } else if (word == "r") {
      repeat([&] { session_.refine_all(); });
    } else if (word == "u") {
      repeat([&] { session_.flip(); });
    } else if (word == "V") {
      repeat([&] { session_.average(); });
    } else if (word == "U") {
      if (live_) {
        session_.toggle_conjugate();
      }
    } else if (word == "conj_grad") {
      const bool on = !accept_name("off");
      accept_name("on");
      if (live_) {
        session_.conjugate(on);
      }
    } else if (word == "hessian" || word == "hessian_seek") {
      repeat([&] { session_.newton_step(); });
    } else if (word == "t") {
      const double length = count_behind(0.0);
      if (live_) {
        session_.remove_tiny(length);
      }
    } else if (word == "o" || word == "pop") {
      repeat([&] { session_.pop_all(); });
    } else if (word == "G") {
      accept(":=");
      const double constant = expression();
      if (live_) {
        session_.gravity(constant);
      }
    } else if (word == "recalc" || word == "recalculate") {
      // Parameters act at once.
    } else if (const auto macro = macros_.find(token.text);
               macro != macros_.end()) {
      const Range range = macro->second;
      repeat([&] { call(range); });
    } else if (live_) {
      fail(token, "a command that is not known here");
    } else {
      // Not run now; take what may belong to it.
      while (!peek().is(";") && !peek().is("}") && !peek().is(")") &&
             !peek().is("{") && !peek().first_on_line &&
             !peek().is_name("else") && !peek().is_name("while") &&
             peek().kind != FeToken::Kind::End) {
        take();
      }
    }
  }

  // Expressions, evaluated as they are read.
  void skip_expression() {
    const bool live = live_;
    live_ = false;
    expression();
    live_ = live;
  }
  double expression() {
    if (++nesting_ > 4 * kMostNesting) {
      fail(peek(), "the expression nests too deep");
    }
    double value = any_of();
    if (accept("?")) {
      const double yes = expression();
      expect(":");
      const double no = expression();
      value = value != 0.0 ? yes : no;
    }
    --nesting_;
    return value;
  }
  double any_of() {
    double value = all_of();
    while (peek().is("||") || peek().is_name("or")) {
      take();
      const double right = all_of();
      value = value != 0.0 || right != 0.0 ? 1.0 : 0.0;
    }
    return value;
  }
  double all_of() {
    double value = inverted();
    while (peek().is("&&") || peek().is_name("and")) {
      take();
      const double right = inverted();
      value = value != 0.0 && right != 0.0 ? 1.0 : 0.0;
    }
    return value;
  }
  double inverted() {
    if (peek().is("!") || peek().is_name("not")) {
      take();
      return inverted() == 0.0 ? 1.0 : 0.0;
    }
    return compared();
  }
  double compared() {
    const double left = sum();
    const std::string sign =
        peek().kind == FeToken::Kind::Symbol ? peek().text : "";
    if (sign == "<" || sign == "<=" || sign == ">" || sign == ">=" ||
        sign == "==" || sign == "=" || sign == "!=") {
      take();
      const double right = sum();
      return sign == "<"    ? left < right
             : sign == "<=" ? left <= right
             : sign == ">"  ? left > right
             : sign == ">=" ? left >= right
             : sign == "!=" ? left != right
                            : left == right;
    }
    return left;
  }
  double sum() {
    double value = product();
    while (peek().is("+") || peek().is("-")) {
      const bool plus = take().text == "+";
      const double right = product();
      value = plus ? value + right : value - right;
    }
    return value;
  }
  double product() {
    double value = power();
    while (peek().is("*") || peek().is("/")) {
      const bool times = take().text == "*";
      const double right = power();
      value = times ? value * right : value / right;
    }
    return value;
  }
  double power() {
    if (accept("-")) {
      return -power();
    }
    if (accept("+")) {
      return power();
    }
    double value = atom();
    while (peek().is("^") || peek().is("**")) {
      take();
      const double right = peek().is("-") ? power() : atom();
      value = std::pow(value, right);
    }
    return value;
  }
  double atom() {
    const FeToken token = take();
    if (token.kind == FeToken::Kind::Number) {
      return token.number;
    }
    if (token.is("(")) {
      const double value = expression();
      expect(")");
      return value;
    }
    if (token.kind != FeToken::Kind::Name) {
      fail(token, "expected a value");
    }
    if (peek().is("[") && (token.text == "body" || token.text == "vertex" ||
                           token.text == "edge" || token.text == "facet")) {
      const Element element = element_of(kind_of(token));
      expect(".");
      return attribute_of(element, take());
    }
    if (peek().is("(")) {
      return function(token);
    }
    if (element_.index >= 0) {
      double value = 0.0;
      int number = 0;
      if (token.text == "on_constraint" || token.text == "on_boundary") {
        number = static_cast<int>(atom());
      }
      if (session_.attribute(element_.kind, element_.index, token.text, number,
                             value)) {
        return value;
      }
    } else if (token.text == "on_constraint" || token.text == "on_boundary") {
      return atom();
    }
    return live_ ? variable(token) : 0.0;
  }
  double attribute_of(const Element& element, const FeToken& what) {
    double value = 0.0;
    if (live_ && !session_.attribute(element.kind, element.index, what.text, 0,
                                     value)) {
      fail(what, "an attribute that is not known");
    }
    return value;
  }
  double function(const FeToken& token) {
    expect("(");
    const double a = expression();
    double b = 0.0;
    if (accept(",")) {
      b = expression();
    }
    expect(")");
    static const std::map<std::string, double (*)(double)> kOne = {
        {"sin", std::sin},   {"cos", std::cos},   {"tan", std::tan},
        {"asin", std::asin}, {"acos", std::acos}, {"atan", std::atan},
        {"exp", std::exp},   {"log", std::log},   {"sqrt", std::sqrt},
        {"abs", std::fabs},  {"sinh", std::sinh}, {"cosh", std::cosh},
        {"tanh", std::tanh}, {"floor", std::floor}, {"ceil", std::ceil}};
    if (const auto found = kOne.find(token.text); found != kOne.end()) {
      return found->second(a);
    }
    if (token.text == "sqr") {
      return a * a;
    }
    if (token.text == "maximum") {
      return std::max(a, b);
    }
    if (token.text == "minimum") {
      return std::min(a, b);
    }
    if (token.text == "atan2") {
      return std::atan2(a, b);
    }
    fail(token, "a function that is not known here");
  }

  const FeFile& file_;
  FeSession& session_;
  const FeScriptOptions& options_;
  std::vector<FeToken> tokens_;
  std::vector<std::size_t> line_start_;
  std::size_t at_ = 0;
  bool live_ = true;
  std::map<std::string, Range> macros_;
  Element element_;
  long steps_ = 0;
  int depth_ = 0;
  int nesting_ = 0;
};

}  // namespace

FeScriptResult run_fe_script(const FeFile& file,
                             const std::map<std::string, double>& parameters,
                             const FeScriptOptions& options) {
  FeSession session(file, parameters, options.monitor);
  Runner runner(file, session, options);
  runner.run_all();
  runner.run_macro(options.macro);
  return {session.complex(), std::move(runner.output), session.iterations()};
}

}  // namespace meniscus
