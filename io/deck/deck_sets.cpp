#include "io/deck/deck_sets.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "core/nearest_name.h"

namespace meniscus::deck {

namespace {

constexpr std::size_t kMostCopied = 20'000'000;

/// What was meant, or nothing.
std::string did_you_mean(const std::string& name,
                         const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(name, names);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

}  // namespace

int DeckNumbers::sort() {
  sorted_.resize(numbers_.size());
  std::iota(sorted_.begin(), sorted_.end(), 0);
  const auto below = [this](int a, int b) { return number(a) < number(b); };
  if (!std::is_sorted(sorted_.begin(), sorted_.end(), below)) {
    std::stable_sort(sorted_.begin(), sorted_.end(), below);
  }
  const auto twice = std::adjacent_find(
      sorted_.begin(), sorted_.end(),
      [this](int a, int b) { return number(a) == number(b); });
  return twice == sorted_.end() ? -1 : *(twice + 1);
}

int DeckNumbers::place_of(int number) const {
  const auto at = std::lower_bound(
      sorted_.begin(), sorted_.end(), number,
      [this](int place, int n) { return this->number(place) < n; });
  return at != sorted_.end() && this->number(*at) == number ? *at : -1;
}

void DeckNumbers::places_in(int first, int last, int step,
                            std::vector<int>& out) const {
  auto at =
      std::lower_bound(sorted_.begin(), sorted_.end(), first,
                       [this](int place, int n) { return number(place) < n; });
  for (; at != sorted_.end() && number(*at) <= last; ++at) {
    if ((static_cast<long>(number(*at)) - first) % step == 0) {
      out.push_back(*at);
    }
  }
}

std::vector<DeckRange>& DeckSets::ranges_of(const std::string& name) {
  const auto [at, is_new] = sets_.try_emplace(name);
  if (is_new) {
    names_.push_back(name);
  }
  return at->second;
}

void DeckSets::add(const std::string& name, const DeckRange& range) {
  std::vector<DeckRange>& ranges = ranges_of(name);
  if (!ranges.empty() && ranges.back().step == 1 && range.step == 1 &&
      ranges.back().last == range.first - 1) {
    ranges.back().last = range.last;
    return;
  }
  ranges.push_back(range);
}

/// Without it sets of sets of sets could grow without bound.
void DeckSets::tidy(std::vector<DeckRange>& ranges) {
  std::sort(ranges.begin(), ranges.end());
  ranges.erase(std::unique(ranges.begin(), ranges.end()), ranges.end());
}

void DeckSets::add_card(const DeckCards& deck, const DeckCard& card) {
  const std::string* name = card.find(what_ == "node" ? "NSET" : "ELSET");
  if (name == nullptr || name->empty()) {
    deck.refuse(card, fmt::format("give the set a name: {}, {}=NAME",
                                  card.written, card.written.substr(1)));
  }
  const bool generated = card.find("GENERATE") != nullptr;
  std::vector<DeckRange>& ranges = ranges_of(*name);
  for (const DeckLine& line : card.lines) {
    if (generated) {
      add_generated(deck, line, *name);
      continue;
    }
    for (const std::string_view field : deck_fields(line.text)) {
      if (!field.empty()) {
        add_field(deck, line, field, *name);
      }
    }
  }
  tidy(ranges);
}

void DeckSets::add_generated(const DeckCards& deck, const DeckLine& line,
                             const std::string& name) {
  const std::vector<std::string_view> fields = deck_fields(line.text);
  DeckRange range;
  const bool good =
      (fields.size() == 2 || fields.size() == 3) &&
      read_deck_integer(fields[0], range.first) &&
      read_deck_integer(fields[1], range.last) &&
      (fields.size() < 3 || read_deck_integer(fields[2], range.step)) &&
      range.first > 0 && range.first <= range.last && range.step > 0;
  if (!good) {
    deck.refuse(line.at,
                fmt::format("'{}' is no range of {}s; GENERATE wants the first "
                            "number, the last and the step, as 1, 99, 2",
                            shown_field(line.text), what_));
  }
  ranges_of(name).push_back(range);
}

void DeckSets::add_field(const DeckCards& deck, const DeckLine& line,
                         std::string_view field, const std::string& name) {
  int number = 0;
  if (read_deck_integer(field, number)) {
    if (number <= 0) {
      deck.refuse(line.at, fmt::format("{} number {}; numbers are above 0",
                                       what_, number));
    }
    add(name, {number, number, 1});
    return;
  }
  const std::string other = deck_word(field);
  const auto at = sets_.find(other);
  if (at == sets_.end()) {
    deck.refuse(line.at, fmt::format("'{}' is neither a number nor a {} set "
                                     "that stands before{}",
                                     shown_field(field), what_,
                                     did_you_mean(other, names_)));
  }
  const std::vector<DeckRange> members = at->second;
  copied_ += members.size();
  if (copied_ > kMostCopied) {
    deck.refuse(line.at, fmt::format("sets of sets come to more than {} ranges "
                                     "of numbers; is one part of many others?",
                                     kMostCopied));
  }
  std::vector<DeckRange>& ranges = ranges_of(name);
  ranges.insert(ranges.end(), members.begin(), members.end());
}

std::vector<int> DeckSets::places(const DeckCards& deck, const DeckPlace& at,
                                  const std::string& name,
                                  const DeckNumbers& numbers) const {
  const auto set = sets_.find(name);
  if (set == sets_.end()) {
    deck.refuse(at, fmt::format("the deck has no {} set '{}'{}", what_,
                                shown_field(name), did_you_mean(name, names_)));
  }
  std::vector<int> places;
  std::vector<DeckRange> ranges = set->second;
  tidy(ranges);
  const std::size_t most = numbers.size();
  for (const DeckRange& range : ranges) {
    numbers.places_in(range.first, range.last, range.step, places);
    if (places.size() > 2 * most) {
      std::sort(places.begin(), places.end());
      places.erase(std::unique(places.begin(), places.end()), places.end());
    }
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

std::vector<int> DeckSets::places_named(const DeckCards& deck,
                                        const DeckPlace& at,
                                        std::string_view field,
                                        const DeckNumbers& numbers) const {
  int number = 0;
  if (!read_deck_integer(field, number)) {
    return places(deck, at, deck_word(field), numbers);
  }
  const int place = numbers.place_of(number);
  if (place < 0) {
    deck.refuse(at, fmt::format("the deck has no {} {}", what_, number));
  }
  return {place};
}

}  // namespace meniscus::deck
