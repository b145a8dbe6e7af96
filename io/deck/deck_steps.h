/// The steps of a deck, by CalculiX's rule: what earlier steps set stays, until
/// OP=NEW or a new value (internal to the deck reader).
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/deck/deck_mesh.h"
#include "io/deck/deck_reader.h"

namespace meniscus::deck {

/// A value and the step that gave it: within a step values of one load add up,
/// the first of a later step replaces what stood.
struct StandingValue {
  double value = 0.0;
  int step = 0;

  void give(double given, int now) {
    value = step == now ? value + given : given;
    step = now;
  }
};

/// GRAV or CENTRIF on the elements that a name stands for.
struct StandingBodyLoad {
  std::string elements;  // the name; empty: all
  DeckPlace at;
  bool spins = false;
  Vec3 point = Vec3::Zero();      // of the axis
  Vec3 direction = Vec3::Zero();  // unit: of gravity, or the axis
  StandingValue size;             // acceleration, or square of the rate
};

using NodeComponent = std::pair<int, int>;  // number of a node, 0 to 2

/// What stands between steps, by numbers of the deck.
struct StandingLoads {
  std::map<NodeComponent, double> held;  // at this displacement
  std::map<NodeComponent, StandingValue> forces;
  std::map<std::array<int, 2>, StandingValue> pressures;  // element, corner off
  std::vector<StandingBodyLoad> body;
  std::map<int, double> initial_temperatures;
  std::map<int, double> temperatures;
};

class DeckStepReader {
 public:
  /// All on loan. `deck` is given the steps.
  DeckStepReader(const DeckCards& cards, const FrozenModel& frozen,
                 ReadDeck& deck);

  /// A card that stands before the first step and is no part of the model:
  /// *BOUNDARY, *INITIAL CONDITIONS; false for any other.
  bool read_before(const DeckCard& card);

  /// A card from the first *STEP on; false for one that is not known.
  bool read(const DeckCard& card);

  /// Throws InvalidInput for a step that has no end, and for none at all.
  void finish();

 private:
  void begin_step(const DeckCard& card);
  void name_step(const DeckCard& card);
  void end_step(const DeckCard& card);
  void procedure(const DeckCard& card);
  void boundary(const DeckCard& card);
  void boundary_line(const DeckLine& line);
  void forces(const DeckCard& card);
  void distributed(const DeckCard& card);
  void face_load(const DeckLine& line,
                 const std::vector<std::string_view>& fields, int off);
  void body_load(const DeckLine& line,
                 const std::vector<std::string_view>& fields);
  void surface_load(const DeckLine& line, std::string_view surface,
                    std::string_view value);
  void surfaces(const DeckCard& card);
  void temperatures(const DeckCard& card, std::map<int, double>& of_node);

  /// True at the first card of its kind in a step, where it says OP=NEW.
  bool starts_anew(const DeckCard& card, char kind);
  /// Numbers of the nodes that a field names.
  std::vector<int> nodes_named(const DeckPlace& at, std::string_view field);
  void press(const DeckPlace& at, int element, int off, double pressure);

  void put_holds(const DeckCard& card, ReadStep& step);
  void put_forces(const DeckCard& card, ReadStep& step);
  void put_pressures(ReadStep& step);
  void put_body_loads(ReadStep& step);
  void put_temperatures(ReadStep& step);
  int mesh_node(int number) const;

  const DeckCards& cards_;
  const FrozenModel& frozen_;
  ReadDeck& deck_;
  StandingLoads standing_;
  int step_ = 0;         // the one under way, from 1; 0: before the first
  bool inside_ = false;  // of a step
  bool has_procedure_ = false;
  bool perturbs_ = false;  // PERTURBATION
  bool preloads_ = false;  // a static step came before
  DeckPlace begun_;
  std::string anew_;  // kinds whose first card of the step was read
};

/// Adds the springs and oblique holds of the model that act in the step, where
/// `held` are the components that it holds, and where (internal).
void put_deck_springs(const DeckCards& cards, const FrozenModel& frozen,
                      const std::map<NodeComponent, double>& held,
                      ReadStep& step);

}  // namespace meniscus::deck
