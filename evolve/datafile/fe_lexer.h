/// Tokens of Surface Evolver datafiles: comments and spliced lines removed,
/// #define macros replaced. Tokens are made one at a time, so memory does not
/// grow with the text.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus::datafile {

/// Where something stands in a file, counted from 1.
struct FePlace {
  int line = 1;
  int column = 1;
};

struct FeToken {
  enum class Kind { Number, Name, String, Symbol, End };
  Kind kind = Kind::End;
  std::string text;     // names in lower case; of numbers as written
  double number = 0.0;  // Number: always finite
  bool upper = false;   // the name's first letter, as written
  bool first_on_line = false;
  bool after_space = false;
  bool before_space = false;
  FePlace place;  // of a macro's tokens: where the macro was used

  bool is(std::string_view symbol) const {
    return kind == Kind::Symbol && text == symbol;
  }
  bool is_name(std::string_view name) const {
    return kind == Kind::Name && text == name;
  }
};

/// All functions throw InvalidInput "name:line:column: what" for characters
/// and numbers that no datafile has, macros that contain themselves or grow
/// beyond bounds, comments and texts without end, and #include.
class FeLexer {
 public:
  /// `text` must outlive the lexer; `name` is that of the file, for messages,
  /// which count lines from `first_line`.
  FeLexer(std::string_view text, std::string name, int first_line = 1);

  const FeToken& peek() const { return token_; }
  FeToken take();  // the token at hand; moves on

  /// Everything behind the token at hand, unread. Empty inside a macro.
  std::string_view rest() const;

  const std::string& name() const { return name_; }
  [[noreturn]] void fail(const FePlace& place, const std::string& what) const;
  /// "..., found 'token'".
  [[noreturn]] void fail_here(const std::string& what) const;

 private:
  struct Frame {
    const std::vector<FeToken>* tokens = nullptr;
    std::size_t next = 0;
    std::string macro;
  };

  void advance();
  bool from_macro(FeToken& token);
  bool expand(const FeToken& token);
  FeToken raw();
  void skip_space(bool within_line);
  void skip_block_comment();
  bool skip_splice();
  void directive(const FePlace& place);
  void number(FeToken& token);
  void quoted(FeToken& token);
  void symbol(FeToken& token);
  std::string_view word();
  char at(std::size_t ahead) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  void newline();
  FePlace here() const;

  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0;
  std::size_t line_start_ = 0;
  int line_ = 1;
  bool new_line_ = true;
  bool space_ = true;
  FeToken token_;
  std::string spelling_;  // of a raw name, as written: macros heed case
  std::map<std::string, std::vector<FeToken>, std::less<>> macros_;
  std::vector<Frame> frames_;
  std::size_t expanded_ = 0;  // macro tokens so far
};

}  // namespace meniscus::datafile
