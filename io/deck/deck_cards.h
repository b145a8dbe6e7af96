/// The text of a deck cut into its keyword cards, by CalculiX's rules: comments
/// and blank lines left out, *INCLUDE followed, keyword lines that end with a
/// comma gone on with in the next one (internal to the deck reader).
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus::deck {

struct DeckPlace {
  int file = 0;  // index of DeckCards::files
  int line = 0;  // from 1
};

/// A line of data; its text belongs to the DeckCards.
struct DeckLine {
  std::string_view text;
  DeckPlace at;
};

struct DeckParameter {
  std::string name;   // capitals, without blanks: "ELSET"
  std::string value;  // the same; quotes stay, as CalculiX keeps them
  std::string given;  // as written, without outer blanks
};

struct DeckCard {
  std::string keyword;  // capitals, without blanks: "SOLIDSECTION"
  std::string written;  // for messages: "*SOLID SECTION"
  std::vector<DeckParameter> parameters;
  std::vector<DeckLine> lines;
  DeckPlace at;
  std::string_view remark;  // a comment in the line before it; or empty

  /// The parameter's value, null where the card does not have it.
  const std::string* find(std::string_view name) const;
};

struct DeckCards {
  std::vector<std::string> files;
  std::deque<std::string> texts;  // of these, in their order
  std::vector<DeckCard> cards;

  /// "deck.inp:12".
  std::string place(const DeckPlace& at) const;
  /// Throws InvalidInput, "deck.inp:12: what".
  [[noreturn]] void refuse(const DeckPlace& at, const std::string& what) const;
  /// The same for a card, "deck.inp:12: *NODE: what".
  [[noreturn]] void refuse(const DeckCard& card, const std::string& what) const;
};

/// Files that *INCLUDE names are read beside the file that names them. Throws
/// IoError for the deck, InvalidInput for an include that cannot be read, is
/// nested too deeply, and for text that is no deck.
DeckCards read_deck_cards(const std::filesystem::path& path);

/// The same of a text in memory, which must not include others. `name`: for
/// messages.
DeckCards cut_deck_text(std::string text, const std::string& name);

/// Without any blanks and in capitals.
std::string deck_word(std::string_view text);

/// The comma-separated fields of a line, without the blanks around them; a
/// comma at its end adds none.
std::vector<std::string_view> deck_fields(std::string_view line);

/// A field as a number, also with Fortran's exponent D; false for anything
/// else, and for one that is not finite.
bool read_deck_number(std::string_view field, double& value);
bool read_deck_integer(std::string_view field, int& value);

/// A field for messages: what can be printed of it, cut to 40 characters.
std::string shown_field(std::string_view field);

}  // namespace meniscus::deck
