#include "io/deck/deck_reader.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "io/deck/deck_mesh.h"
#include "io/deck/deck_model.h"
#include "io/deck/deck_steps.h"

namespace meniscus::deck {

namespace {

/// Says nothing about the answer: output, restarts, how other solvers iterate.
bool is_not_needed(const std::string& keyword) {
  static const std::vector<std::string> kKeywords = {
      "NODEFILE",      "ELFILE",
      "NODEPRINT",     "ELPRINT",
      "OUTPUT",        "NODEOUTPUT",
      "ELEMENTOUTPUT", "CONTACTFILE",
      "CONTACTPRINT",  "FACEPRINT",
      "SECTIONPRINT",  "ENERGYOUTPUT",
      "ENERGYPRINT",   "FILEFORMAT",
      "PRINT",         "PREPRINT",
      "RESTART",       "MONITOR",
      "CONTROLS",      "TIMEPOINTS",
      "AMPLITUDE",     "CONDUCTIVITY",
      "SPECIFICHEAT",  "PHYSICALCONSTANTS",
      "CONTACTOUTPUT", "ELEMENTMATRIXOUTPUT"};
  return std::find(kKeywords.begin(), kKeywords.end(), keyword) !=
         kKeywords.end();
}

/// What to do instead, of keywords that people meet.
std::string advice_for(const std::string& keyword) {
  static const std::map<std::string, std::string> kAdvice = {
      {"PART",
       "write the deck without parts and assemblies, as CalculiX reads "
       "it"},
      {"ASSEMBLY", "write the deck without parts and assemblies"},
      {"INSTANCE", "write the deck without parts and assemblies"},
      {"TIE", "mesh the bodies with common nodes"},
      {"CONTACTPAIR", "mesh the bodies with common nodes, or hold the surface"},
      {"PLASTIC",
       "only linear elasticity is known; leave it out for the "
       "elastic answer"},
      {"SHELLSECTION", "mesh the part with C3D4 or C3D10"},
      {"BEAMSECTION", "mesh the part with C3D4 or C3D10"},
      {"TRANSFORM", "give supports and forces along x, y and z"},
      {"DYNAMIC", "only *STATIC, *FREQUENCY and *BUCKLE are known"},
      {"MODALDYNAMIC", "only *STATIC, *FREQUENCY and *BUCKLE are known"},
      {"HEATTRANSFER", "only *STATIC, *FREQUENCY and *BUCKLE are known"},
      {"RIGIDBODY", "give its forces by *CLOAD or *DSLOAD"},
      {"COUPLING", "give its forces by *CLOAD or *DSLOAD"}};
  const auto at = kAdvice.find(keyword);
  return at == kAdvice.end()
             ? "leave it out if the answer does not depend on it "
               "(docs/decks.md lists what is known)"
             : at->second;
}

bool is_of_model(const std::string& keyword) {
  static const std::vector<std::string> kKeywords = {
      "NODE",      "ELEMENT",          "NSET",         "ELSET",
      "SURFACE",   "MATERIAL",         "ELASTIC",      "DENSITY",
      "EXPANSION", "ORIENTATION",      "SOLIDSECTION", "SPRING",
      "EQUATION",  "INITIALCONDITIONS"};
  return std::find(kKeywords.begin(), kKeywords.end(), keyword) !=
         kKeywords.end();
}

class DeckReader {
 public:
  explicit DeckReader(const DeckCards& cards) : cards_(cards), model_(cards) {}

  ReadDeck read() {
    if (cards_.cards.empty()) {
      cards_.refuse(DeckPlace{0, 1},
                    "the file has no keyword; expected a deck of CalculiX or "
                    "Abaqus");
    }
    for (const DeckCard& card : cards_.cards) {
      read_card(card);
    }
    freeze();
    steps_->finish();
    return std::move(deck_);
  }

 private:
  void read_card(const DeckCard& card) {
    if (is_not_needed(card.keyword)) {
      if (seen_.insert(card.keyword).second) {
        deck_.not_needed.push_back(
            fmt::format("{} ({})", card.written, cards_.place(card.at)));
      }
      return;
    }
    if (card.keyword == "STEP") {
      freeze();
    }
    if (steps_) {
      if (is_of_model(card.keyword)) {
        cards_.refuse(card, "belongs before the first *STEP");
      }
      if (steps_->read(card)) {
        return;
      }
    } else if (card.keyword == "BOUNDARY" ||
               card.keyword == "INITIALCONDITIONS") {
      waiting_.push_back(&card);
      return;
    } else if (model_.read(card)) {
      return;
    }
    cards_.refuse(card,
                  "this keyword is not known; " + advice_for(card.keyword));
  }

  /// The model is whole: the first step begins, or the file ends.
  void freeze() {
    if (steps_) {
      return;
    }
    frozen_ = freeze_deck_model(cards_, model_.take(), deck_);
    steps_.emplace(cards_, frozen_, deck_);
    for (const DeckCard* card : waiting_) {
      steps_->read_before(*card);
    }
  }

  const DeckCards& cards_;
  ReadDeck deck_;
  DeckModelReader model_;
  FrozenModel frozen_;
  std::optional<DeckStepReader> steps_;
  std::vector<const DeckCard*> waiting_;  // until there is a mesh
  std::set<std::string> seen_;
};

}  // namespace

std::string ReadDeck::place_of_element(int element) const {
  const auto& [file, line] = element_places[static_cast<std::size_t>(element)];
  return fmt::format("{}:{}", element_files[static_cast<std::size_t>(file)],
                     line);
}

ReadDeck read_deck(const std::filesystem::path& path) {
  return DeckReader(read_deck_cards(path)).read();
}

ReadDeck read_deck_text(const std::string& text, const std::string& name) {
  return DeckReader(cut_deck_text(text, name)).read();
}

}  // namespace meniscus::deck
