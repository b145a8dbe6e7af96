#include "io/deck/deck_cards.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/file_notes.h"

namespace meniscus::deck {

namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 10;  // files that include each other
constexpr std::size_t kMostFiles = 1000;
constexpr std::size_t kShownField = 40;  // characters

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view without_blanks_around(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) {
    text.remove_prefix(1);
  }
  while (!text.empty() && is_blank(text.back())) {
    text.remove_suffix(1);
  }
  return text;
}

class CardCutter {
 public:
  CardCutter(DeckCards& deck, bool includes)
      : deck_(deck), includes_(includes) {}

  void cut_file(std::string text, const std::string& name, int depth) {
    const int file = static_cast<int>(deck_.files.size());
    deck_.files.push_back(name);
    deck_.texts.push_back(std::move(text));
    const std::string_view all = deck_.texts.back();
    if (all.find('\0') != std::string_view::npos) {
      const auto zero = static_cast<std::ptrdiff_t>(all.find('\0'));
      const auto line = 1 + std::count(all.begin(), all.begin() + zero, '\n');
      deck_.refuse({file, static_cast<int>(line)},
                   "a byte 0 stands here: this is no text; expected a deck of "
                   "CalculiX or Abaqus");
    }
    std::string_view remark;
    DeckPlace at{file, 0};
    for (std::size_t begin = 0; begin < all.size();) {
      const std::size_t end = std::min(all.find('\n', begin), all.size());
      const std::string_view line =
          without_blanks_around(all.substr(begin, end - begin));
      begin = end + 1;
      ++at.line;
      if (line.substr(0, 2) == "**") {
        remark = without_blanks_around(line.substr(2));
        continue;
      }
      add_line(line, at, remark, depth);
      remark = {};
    }
    if (open_ >= 0) {
      deck_.refuse(deck_.cards[static_cast<std::size_t>(open_)],
                   "its line ends with a comma, and the file ends there");
    }
  }

 private:
  void add_line(std::string_view line, const DeckPlace& at,
                std::string_view remark, int depth) {
    if (open_ >= 0) {
      DeckCard& card = deck_.cards[static_cast<std::size_t>(open_)];
      add_parameters(deck_fields(line), card);
      end_keyword_line(line, depth);
      return;
    }
    if (line.empty()) {
      return;
    }
    if (line.front() == '*') {
      begin_card(line, at, remark);
      end_keyword_line(line, depth);
      return;
    }
    if (deck_.cards.empty()) {
      deck_.refuse(at, fmt::format("'{}' stands before the first keyword; a "
                                   "deck begins with one, such as *NODE",
                                   shown_field(line)));
    }
    deck_.cards.back().lines.push_back({line, at});
  }

  void begin_card(std::string_view line, const DeckPlace& at,
                  std::string_view remark) {
    std::vector<std::string_view> fields = deck_fields(line);
    DeckCard& card = deck_.cards.emplace_back();
    card.at = at;
    card.remark = remark;
    card.keyword = deck_word(fields.front().substr(1));
    card.written = "*" + shown_field(fields.front().substr(1));
    std::transform(
        card.written.begin(), card.written.end(), card.written.begin(),
        [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    fields.erase(fields.begin());
    add_parameters(fields, card);
  }

  static void add_parameters(const std::vector<std::string_view>& fields,
                             DeckCard& card) {
    for (const std::string_view field : fields) {
      if (field.empty()) {
        continue;
      }
      const std::size_t equals = std::min(field.find('='), field.size());
      const std::string_view value =
          equals < field.size() ? field.substr(equals + 1) : std::string_view();
      card.parameters.push_back({deck_word(field.substr(0, equals)),
                                 deck_word(value),
                                 std::string(without_blanks_around(value))});
    }
  }

  /// A comma at the end leaves the card open.
  void end_keyword_line(std::string_view line, int depth) {
    const int last = static_cast<int>(deck_.cards.size()) - 1;
    open_ = !line.empty() && line.back() == ',' ? last : -1;
    if (open_ < 0 && deck_.cards.back().keyword == "INCLUDE") {
      const DeckCard card = std::move(deck_.cards.back());
      deck_.cards.pop_back();
      include(card, depth);
    }
  }

  void include(const DeckCard& card, int depth) {
    std::string name;
    for (const DeckParameter& parameter : card.parameters) {
      if (parameter.name == "INPUT") {
        name = parameter.given;
      }
    }
    if (name.size() > 1 && name.front() == '"' && name.back() == '"') {
      name = name.substr(1, name.size() - 2);
    }
    if (name.empty()) {
      deck_.refuse(card, "say which file: *INCLUDE, INPUT=FILE");
    }
    if (!includes_) {
      deck_.refuse(card, "a text in memory cannot include files");
    }
    if (depth >= kDeepest || deck_.files.size() >= kMostFiles) {
      deck_.refuse(card, fmt::format("files include each other {} deep, or are "
                                     "more than {}; does one include itself?",
                                     depth, kMostFiles));
    }
    const fs::path beside =
        fs::path(deck_.files[static_cast<std::size_t>(card.at.file)])
            .parent_path();
    const fs::path path = beside / name;
    std::string text;
    try {
      text = read_file(path);
    } catch (const IoError& error) {
      deck_.refuse(card, error.what());
    }
    cut_file(std::move(text), path.string(), depth + 1);
  }

  DeckCards& deck_;
  bool includes_;
  int open_ = -1;  // the card whose keyword line goes on; -1: none
};

}  // namespace

const std::string* DeckCard::find(std::string_view name) const {
  for (const DeckParameter& parameter : parameters) {
    if (parameter.name == name) {
      return &parameter.value;
    }
  }
  return nullptr;
}

std::string DeckCards::place(const DeckPlace& at) const {
  return fmt::format("{}:{}", files[static_cast<std::size_t>(at.file)],
                     at.line);
}

void DeckCards::refuse(const DeckPlace& at, const std::string& what) const {
  throw InvalidInput(fmt::format("{}: {}", place(at), what));
}

void DeckCards::refuse(const DeckCard& card, const std::string& what) const {
  refuse(card.at, fmt::format("{}: {}", card.written, what));
}

DeckCards read_deck_cards(const fs::path& path) {
  DeckCards deck;
  CardCutter(deck, true).cut_file(read_file(path), path.string(), 0);
  return deck;
}

DeckCards cut_deck_text(std::string text, const std::string& name) {
  DeckCards deck;
  CardCutter(deck, false).cut_file(std::move(text), name, 0);
  return deck;
}

std::string deck_word(std::string_view text) {
  std::string word;
  for (const char c : text) {
    if (!is_blank(c)) {
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  return word;
}

std::vector<std::string_view> deck_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = std::min(line.find(','), line.size());
    fields.push_back(without_blanks_around(line.substr(0, comma)));
    if (comma + 1 >= line.size()) {
      return fields;
    }
    line.remove_prefix(comma + 1);
  }
}

bool read_deck_number(std::string_view field, double& value) {
  constexpr std::size_t kLongest = 64;
  std::array<char, kLongest> text{};
  if (!field.empty() && field.front() == '+') {
    field.remove_prefix(1);
  }
  if (field.empty() || field.size() > text.size() || field.front() == '+') {
    return false;
  }
  std::transform(field.begin(), field.end(), text.begin(),
                 [](char c) { return c == 'd' || c == 'D' ? 'e' : c; });
  const char* end = text.data() + field.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && at == end && std::isfinite(value);
}

bool read_deck_integer(std::string_view field, int& value) {
  const char* end = field.data() + field.size();
  const auto [at, error] = std::from_chars(field.data(), end, value);
  return !field.empty() && error == std::errc() && at == end;
}

std::string shown_field(std::string_view field) {
  std::string text = io::one_line(std::string(field.substr(0, kShownField)));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) >= 128) {
      c = '?';
    }
  }
  return field.size() > kShownField ? text + "..." : text;
}

}  // namespace meniscus::deck
