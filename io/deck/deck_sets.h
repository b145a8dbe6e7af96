/// Sets of a deck's nodes or elements, by name (internal to the deck reader).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/deck/deck_cards.h"

namespace meniscus::deck {

/// What has a number in the deck: numbers ascending, and where each stands in
/// the order of the file.
class DeckNumbers {
 public:
  void add(int number) { numbers_.push_back(number); }
  /// To be called once, after the last add(). Returns a place in the order of
  /// adding whose number stands there for the second time; -1: none.
  int sort();
  std::size_t size() const { return numbers_.size(); }
  int number(int place) const {
    return numbers_[static_cast<std::size_t>(place)];
  }
  /// The place in the order of adding; -1: there is none of that number.
  int place_of(int number) const;
  /// Places of the numbers first, first + step, ... up to last that there are.
  void places_in(int first, int last, int step, std::vector<int>& out) const;

 private:
  std::vector<int> numbers_;  // in the order of adding
  std::vector<int> sorted_;   // places, by number
};

/// Numbers first, first + step, ... up to last.
struct DeckRange {
  int first = 0;
  int last = 0;
  int step = 1;

  auto operator<=>(const DeckRange&) const = default;
};

/// Sets as CalculiX keeps them: a name that comes again adds to its set.
class DeckSets {
 public:
  /// `what`: "node" or "element", for messages.
  explicit DeckSets(std::string what) : what_(std::move(what)) {}

  /// Adds to the set; it is there then, even without a number.
  void add(const std::string& name, const DeckRange& range);
  /// The lines of *NSET or *ELSET: numbers, ranges (GENERATE), names of sets.
  void add_card(const DeckCards& deck, const DeckCard& card);

  bool has(const std::string& name) const { return sets_.count(name) > 0; }
  /// Places, ascending, each once. Throws InvalidInput where there is no such
  /// set.
  std::vector<int> places(const DeckCards& deck, const DeckPlace& at,
                          const std::string& name,
                          const DeckNumbers& numbers) const;
  /// A number's or a set's, as lines of loads and supports name them. Throws
  /// InvalidInput where there is neither.
  std::vector<int> places_named(const DeckCards& deck, const DeckPlace& at,
                                std::string_view field,
                                const DeckNumbers& numbers) const;
  /// Names in the order in which they came.
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<DeckRange>& ranges_of(const std::string& name);
  void add_generated(const DeckCards& deck, const DeckLine& line,
                     const std::string& name);
  void add_field(const DeckCards& deck, const DeckLine& line,
                 std::string_view field, const std::string& name);
  static void tidy(std::vector<DeckRange>& ranges);

  std::string what_;
  std::map<std::string, std::vector<DeckRange>> sets_;
  std::vector<std::string> names_;
  std::size_t copied_ = 0;  // ranges, from sets into others
};

}  // namespace meniscus::deck
