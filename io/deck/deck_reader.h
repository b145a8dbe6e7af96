/// Decks of CalculiX and Abaqus read: a mesh of C3D4 or C3D10 elements, what it
/// is made of, what holds and loads it step by step.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "io/analysis_deck.h"

namespace meniscus::deck {

enum class DeckProcedure { Static, Frequency, Buckling };

/// A node of the mesh held along a direction.
struct ReadHold {
  int node = 0;  // from 0
  Vec3 direction = Vec3::UnitX();
  double displacement = 0.0;  // that it is held at along it [length]
};

/// Pressure on one face of an element, inner faces too, positive into the
/// element.
struct ReadPressure {
  int element = 0;          // from 0
  int opposite_corner = 0;  // 0 to 3: the corner that the face has not
  double pressure = 0.0;    // [pressure]
};

/// Force per mass on elements.
struct ReadBodyLoad {
  std::vector<int> elements;         // from 0, ascending
  Vec3 gravity = Vec3::Zero();       // [length/time^2]
  std::optional<io::DeckSpin> spin;  // or this
};

/// It pulls with stiffness x e on e = sum coefficients . u.
struct ReadSpring {
  double stiffness = 0.0;  // above 0 [force/length]
  std::vector<int> nodes;  // of the mesh, from 0
  Points coefficients;     // one per node
};

/// All that acts in a step, what earlier ones left standing included.
struct ReadStep {
  std::string name;   // NAME=, a remark "load case 'NAME'" before *STEP, or
                      // "step_2"; each once
  std::string place;  // "deck.inp:120"
  DeckProcedure procedure = DeckProcedure::Static;
  int modes = 0;                // of Frequency and Buckling
  std::vector<ReadHold> holds;  // by node
  std::vector<ReadSpring> springs;
  VectorX nodal_forces;  // [force], 3 per node, or empty
  std::vector<ReadPressure> pressures;
  std::vector<ReadBodyLoad> body_loads;
  VectorX temperature_change;  // one per node, or empty [temperature]
};

struct ReadDeck {
  std::string heading;  // the first line of *HEADING
  /// Regions are what has a section of its own. Faces have the label of the
  /// first *SURFACE that they are of, else of the first *NSET (not of all
  /// nodes) that has all of their nodes, else "outside", or "inside" between
  /// regions.
  TetMesh mesh;
  std::vector<int> node_numbers;     // of the deck, one per node
  std::vector<int> element_numbers;  // the same of elements
  std::vector<std::string> element_files;
  std::vector<std::array<int, 2>> element_places;  // file, line
  std::vector<io::DeckMaterial> materials;         // one per region
  std::vector<std::string> material_places;        // "deck.inp:80"
  std::vector<ReadStep> steps;
  std::vector<std::string> not_needed;  // "*NODE FILE (deck.inp:91)"

  /// "deck.inp:12", the line of an element of the mesh.
  std::string place_of_element(int element) const;
};

/// Reads docs/decks.md's keywords and refuses all others. Throws IoError, and
/// InvalidInput with file, line, keyword and what to do.
ReadDeck read_deck(const std::filesystem::path& path);

/// The same from memory, without *INCLUDE. `name`: for messages.
ReadDeck read_deck_text(const std::string& text, const std::string& name);

}  // namespace meniscus::deck
