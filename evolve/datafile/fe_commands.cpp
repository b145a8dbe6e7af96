#include "evolve/datafile/fe_commands.h"

#include <set>

#include <fmt/format.h>

#include "core/nearest_name.h"
#include "evolve/datafile/fe_command_words.h"

namespace meniscus::datafile {

namespace {

constexpr int kDeepestCommand = 100;

class CommandParser {
 public:
  CommandParser(std::string_view text, const std::string& name, int first_line)
      : lexer_(text, name, first_line) {}

  std::vector<FeStatement> parse() {
    std::vector<FeStatement> all;
    while (lexer_.peek().kind != FeToken::Kind::End) {
      if (lexer_.peek().is(";")) {
        lexer_.take();
        continue;
      }
      all.push_back(statement());
      if (!ended() && lexer_.peek().kind != FeToken::Kind::End) {
        lexer_.fail_here("';' or a new line is expected");
      }
    }
    for (const FePlaceOf& call : calls_) {
      if (defined_.count(call.name) == 0) {
        unknown(call);
      }
    }
    return all;
  }

 private:
  struct FePlaceOf {
    std::string name;
    FePlace place;
  };

  [[noreturn]] void unknown(const FePlaceOf& call) const {
    std::vector<std::string> known(defined_.begin(), defined_.end());
    for (const CommandWords& group :
         {command_words(), command_toggles(), element_commands()}) {
      known.insert(known.end(), group.begin(), group.end());
    }
    const std::string near = nearest_name(call.name, known);
    lexer_.fail(
        call.place,
        fmt::format("command '{}' is not known or not supported{}", call.name,
                    near.empty() ? "" : "; is '" + near + "' meant?"));
  }

  // Commands end at ';', before '}', on a new line outside of blocks, and
  // behind blocks.
  bool ended() const {
    const FeToken& token = lexer_.peek();
    return token.is(";") || token.is("}") || behind_block_ ||
           token.kind == FeToken::Kind::End ||
           (depth_ == 0 && token.first_on_line);
  }

  bool skip_if(std::string_view symbol) {
    if (!lexer_.peek().is(symbol)) {
      return false;
    }
    lexer_.take();
    return true;
  }

  void expect(std::string_view symbol) {
    if (!skip_if(symbol)) {
      lexer_.fail_here(fmt::format("'{}' is expected", symbol));
    }
  }

  void expect_word(std::string_view word) {
    if (!lexer_.peek().is_name(word)) {
      lexer_.fail_here(fmt::format("'{}' is expected", word));
    }
    lexer_.take();
  }

  FeExpression expression() {
    return parse_expression(lexer_, FeDialect::Commands);
  }

  FeStatement made(FeStatement::Kind kind, const FeToken& token) const {
    FeStatement statement;
    statement.kind = kind;
    statement.name = token.text;
    statement.place = token.place;
    return statement;
  }

  FeStatement statement() {
    if (++nesting_ > kDeepestCommand) {
      lexer_.fail(lexer_.peek().place,
                  fmt::format("commands are nested more than {} deep",
                              kDeepestCommand));
    }
    behind_block_ = false;
    FeStatement result = lexer_.peek().is("{") ? block() : simple();
    --nesting_;
    return result;
  }

  FeStatement block() {
    FeStatement result = made(FeStatement::Kind::Block, lexer_.take());
    ++depth_;
    while (!taken_brace()) {
      if (skip_if(";")) {
        continue;
      }
      if (lexer_.peek().kind == FeToken::Kind::End) {
        lexer_.fail(result.place, "the block that starts here has no '}'");
      }
      result.body.push_back(statement());
      if (!ended()) {
        lexer_.fail_here("';' or '}' is expected");
      }
    }
    behind_block_ = true;
    if (lexer_.peek().kind == FeToken::Kind::Number &&
        !lexer_.peek().first_on_line) {
      result.values.push_back(expression());
    }
    return result;
  }

  bool taken_brace() {
    if (!lexer_.peek().is("}")) {
      return false;
    }
    --depth_;
    lexer_.take();
    return true;
  }

  FeStatement simple() {
    const FeToken& token = lexer_.peek();
    if (token.kind != FeToken::Kind::Name) {
      lexer_.fail_here("a command is expected");
    }
    if (token.text.size() == 1) {
      return letter();
    }
    static const std::map<std::string, FeStatement (CommandParser::*)(),
                          std::less<>>
        kKeywords = {{"if", &CommandParser::condition},
                     {"while", &CommandParser::while_loop},
                     {"do", &CommandParser::do_loop},
                     {"for", &CommandParser::for_loop},
                     {"foreach", &CommandParser::foreach_loop},
                     {"print", &CommandParser::print},
                     {"printf", &CommandParser::printf},
                     {"set", &CommandParser::set},
                     {"unset", &CommandParser::set},
                     {"define", &CommandParser::attribute},
                     {"addload", &CommandParser::add_load}};
    if (const auto found = kKeywords.find(token.text);
        found != kKeywords.end()) {
      return (this->*found->second)();
    }
    if (token.text == "break" || token.text == "continue") {
      const FeToken word = lexer_.take();
      return made(word.text == "break" ? FeStatement::Kind::Break
                                       : FeStatement::Kind::Continue,
                  word);
    }
    if (element_commands().count(token.text) != 0) {
      FeStatement result = made(FeStatement::Kind::Elements, lexer_.take());
      result.elements = elements();
      return result;
    }
    if (command_toggles().count(token.text) != 0) {
      return toggle();
    }
    if (command_words().count(token.text) != 0) {
      FeStatement result = made(FeStatement::Kind::Word, lexer_.take());
      optional_number(result);
      return result;
    }
    return assignment_or_call();
  }

  // A number or a formula behind a command, on its line.
  void optional_number(FeStatement& statement) {
    const FeToken& token = lexer_.peek();
    const bool starts = token.kind == FeToken::Kind::Number ||
                        token.kind == FeToken::Kind::Name || token.is("(") ||
                        token.is("-");
    if (!ended() && starts && !token.is_name("else")) {
      statement.values.push_back(expression());
    }
  }

  FeStatement letter() {
    FeToken token = lexer_.take();
    if (token.upper) {
      token.text.front() = static_cast<char>(token.text.front() - 'a' + 'A');
    }
    FeStatement result = made(FeStatement::Kind::Letter, token);
    optional_number(result);
    return result;
  }

  FeStatement toggle() {
    FeStatement result = made(FeStatement::Kind::Toggle, lexer_.take());
    if (lexer_.peek().is_name("on") || lexer_.peek().is_name("off")) {
      FeExpression value;
      value.number = lexer_.take().text == "on" ? 1.0 : 0.0;
      result.values.push_back(std::move(value));
    }
    return result;
  }

  FeStatement condition() {
    FeStatement result = made(FeStatement::Kind::If, lexer_.take());
    result.values.push_back(expression());
    expect_word("then");
    result.body.push_back(statement());
    if (lexer_.peek().is_name("else")) {
      lexer_.take();
      result.body.push_back(statement());
    }
    return result;
  }

  FeStatement while_loop() {
    FeStatement result = made(FeStatement::Kind::While, lexer_.take());
    result.values.push_back(expression());
    expect_word("do");
    result.body.push_back(statement());
    return result;
  }

  FeStatement do_loop() {
    FeStatement result = made(FeStatement::Kind::DoWhile, lexer_.take());
    result.body.push_back(statement());
    skip_if(";");
    expect_word("while");
    behind_block_ = false;
    result.values.push_back(expression());
    return result;
  }

  FeStatement for_loop() {
    FeStatement result = made(FeStatement::Kind::For, lexer_.take());
    expect("(");
    ++depth_;
    result.body.push_back(statement());
    expect(";");
    result.values.push_back(expression());
    expect(";");
    result.body.push_back(statement());
    --depth_;
    expect(")");
    result.body.push_back(statement());
    return result;
  }

  FeStatement foreach_loop() {
    FeStatement result = made(FeStatement::Kind::Foreach, lexer_.take());
    result.elements = elements();
    expect_word("do");
    result.body.push_back(statement());
    return result;
  }

  FeElements elements() {
    FeElements result;
    result.path = parse_path(lexer_);
    if (!ended() && lexer_.peek().kind == FeToken::Kind::Name &&
        !lexer_.peek().is_name("where") && !lexer_.peek().is_name("do")) {
      result.variable = lexer_.take().text;
    }
    condition_of(result);
    return result;
  }

  void condition_of(FeElements& result) {
    if (lexer_.peek().is_name("where")) {
      lexer_.take();
      result.where.push_back(expression());
    }
  }

  FeStatement print() {
    FeStatement result = made(FeStatement::Kind::Print, lexer_.take());
    result.values.push_back(expression());
    return result;
  }

  FeStatement printf() {
    FeStatement result = made(FeStatement::Kind::Printf, lexer_.take());
    if (lexer_.peek().kind != FeToken::Kind::String) {
      lexer_.fail_here("printf needs a format in quotes");
    }
    do {
      result.values.push_back(expression());
    } while (skip_if(","));
    return result;
  }

  // set vertex y y + 1 where z > 0
  FeStatement set() {
    const FeToken word = lexer_.take();
    FeStatement result = made(
        word.text == "set" ? FeStatement::Kind::Set : FeStatement::Kind::Unset,
        word);
    result.elements.path = parse_path(lexer_);
    if (lexer_.peek().kind != FeToken::Kind::Name) {
      lexer_.fail_here("an attribute is expected");
    }
    result.name = lexer_.take().text;
    if (!ended() && !lexer_.peek().is_name("where")) {
      result.values.push_back(expression());
    }
    condition_of(result.elements);
    return result;
  }

  FeStatement attribute() {
    FeStatement result = made(FeStatement::Kind::Attribute, lexer_.take());
    result.elements.path = parse_path(lexer_);
    expect_word("attribute");
    result.name = lexer_.peek().text;
    parse_path(lexer_);
    if (!lexer_.peek().is_name("real") && !lexer_.peek().is_name("integer")) {
      lexer_.fail_here("'real' or 'integer' is expected");
    }
    lexer_.take();
    return result;
  }

  FeStatement add_load() {
    FeStatement result = made(FeStatement::Kind::AddLoad, lexer_.take());
    result.values.push_back(expression());
    return result;
  }

  FeStatement assignment_or_call() {
    const FeToken start = lexer_.peek();
    FeExpression target = parse_path(lexer_);
    const FeToken& next = lexer_.peek();
    const bool name_alone = target.nodes.size() == 1;
    if (name_alone &&
        (ended() || next.is(")") || next.kind == FeToken::Kind::Number ||
         next.kind == FeToken::Kind::Name)) {
      calls_.push_back({start.text, start.place});
      FeStatement result = made(FeStatement::Kind::Call, start);
      optional_number(result);
      return result;
    }
    FeStatement result = made(FeStatement::Kind::Assign, start);
    result.values.push_back(std::move(target));
    const FeToken sign = lexer_.take();
    if (!sign.is(":") && !sign.is("+") && !sign.is("-") && !sign.is("*") &&
        !sign.is("/")) {
      lexer_.fail(
          sign.place,
          fmt::format("a command or ':=' is expected, found '{}'", sign.text));
    }
    result.name = sign.text + "=";
    if ((sign.is("+") || sign.is("-")) && skip_if(sign.text)) {
      FeExpression one;
      one.number = 1.0;
      result.values.push_back(std::move(one));
      return result;
    }
    expect("=");
    if (sign.is(":") && name_alone && lexer_.peek().is("{")) {
      defined_.insert(start.text);
      FeStatement body = block();
      result.kind = FeStatement::Kind::Define;
      result.name = start.text;
      result.values.clear();
      result.body = std::move(body.body);
      return result;
    }
    result.values.push_back(expression());
    return result;
  }

  FeLexer lexer_;
  std::set<std::string> defined_;
  std::vector<FePlaceOf> calls_;
  int depth_ = 0;    // braces and brackets: lines do not end commands
  int nesting_ = 0;  // of statements
  bool behind_block_ = false;
};

}  // namespace

std::vector<FeStatement> parse_commands(std::string_view text,
                                        const std::string& name,
                                        int first_line) {
  return CommandParser(text, name, first_line).parse();
}

}  // namespace meniscus::datafile
