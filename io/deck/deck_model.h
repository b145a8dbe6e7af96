/// The model part of a deck as its cards say it, before the first step
/// (internal to the deck reader).
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"
#include "io/analysis_deck.h"
#include "io/deck/deck_cards.h"
#include "io/deck/deck_sets.h"

namespace meniscus::deck {

struct RawElement {
  std::array<int, 10> nodes{};  // numbers of the deck, 4 or 10 of them
  DeckPlace at;
};

/// A spring between one component of a node and the ground.
struct RawSpring {
  int node = 0;  // number of the deck
  int element = 0;
  DeckPlace at;
};

/// The stiffness of an element set's springs.
struct RawSpringSection {
  std::string elset;
  int component = 0;  // 0 to 2
  double stiffness = 0.0;
  DeckPlace at;
};

/// sum of coefficient x component of a node = 0.
struct RawEquation {
  struct Term {
    int node = 0;  // number of the deck
    int component = 0;
    double coefficient = 0.0;
  };
  std::vector<Term> terms;
  DeckPlace at;
};

struct RawMaterial {
  io::DeckMaterial material;
  bool elastic = false;
  DeckPlace at;
};

struct RawSection {
  std::string elset;
  std::string material;
  std::string orientation;  // or empty
  DeckPlace at;
};

struct RawFace {
  std::string elements;  // a number or a set
  int opposite_corner = 0;
  DeckPlace at;
};

struct DeckModel {
  std::string heading;
  DeckNumbers node_numbers;
  Points nodes;
  std::vector<DeckPlace> node_places;
  int nodes_per_element = 0;  // 4 or 10; 0: no element yet
  DeckNumbers element_numbers;
  std::vector<RawElement> elements;
  DeckSets node_sets{"node"};
  DeckSets element_sets{"element"};
  std::vector<std::string> surface_names;  // in the order in which they came
  std::map<std::string, std::vector<RawFace>> surfaces;
  std::vector<std::string> material_names;
  std::map<std::string, RawMaterial> materials;
  std::map<std::string, io::DeckOrthotropic> orientations;  // axes alone
  std::vector<RawSection> sections;
  std::vector<RawSpring> springs;
  std::map<std::string, std::vector<int>> spring_sets;  // places of springs
  std::vector<RawSpringSection> spring_sections;
  std::vector<RawEquation> equations;
  std::vector<std::string> not_needed;  // elements of lines and surfaces
};

/// Adds what the card says where it is one of the model; false for any other.
/// Throws InvalidInput for what it cannot be.
class DeckModelReader {
 public:
  explicit DeckModelReader(const DeckCards& deck) : deck_(deck) {}

  bool read(const DeckCard& card);
  DeckModel take() { return std::move(model_); }

 private:
  void nodes(const DeckCard& card);
  void elements(const DeckCard& card);
  void spring_elements(const DeckCard& card);
  void surface(const DeckCard& card);
  void material(const DeckCard& card);
  void elastic(const DeckCard& card);
  void density(const DeckCard& card);
  void expansion(const DeckCard& card);
  void orientation(const DeckCard& card);
  void section(const DeckCard& card);
  void spring(const DeckCard& card);
  void equations(const DeckCard& card);

  RawMaterial& current(const DeckCard& card);
  /// The numbers of a card that must have one line of them, `least` or more.
  std::vector<double> numbers(const DeckCard& card, std::size_t least,
                              std::size_t most, const char* expected) const;

  const DeckCards& deck_;
  DeckModel model_;
  std::string material_;  // the one under way
};

/// Throws InvalidInput for a parameter of the card that is none of `known`.
void check_deck_parameters(const DeckCards& deck, const DeckCard& card,
                           const std::vector<std::string>& known);

/// The component that a field names, 1 to 3, from 0. Throws InvalidInput.
int read_deck_component(const DeckCards& deck, const DeckPlace& at,
                        std::string_view field);

/// A finite number. Throws InvalidInput; `what`: "the force".
double require_deck_number(const DeckCards& deck, const DeckPlace& at,
                           std::string_view field, const char* what);

/// "S2" or "P2" as the corner that the face has not, 0 to 3; -1: neither.
int corner_off_deck_face(std::string_view label, char letter);

}  // namespace meniscus::deck
