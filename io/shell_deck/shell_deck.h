/// A shell as a static job for another solver, beside analysis_deck.h's of
/// tetrahedra: what the writers of its decks (CalculiX, Nastran) are given.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"
#include "io/analysis_deck.h"

namespace meniscus::shell_deck {

/// An orthotropic one's own axes are not read: axis 1 lies in the facet, turned
/// by `angle` about the normal from the section's direction.
struct DeckPly {
  io::DeckMaterial material;
  double share = 1.0;  // of the thickness; all of a section sum to 1
  double angle = 0.0;  // [rad]
};

/// How facets' walls lie and what they are made of.
struct DeckShellSection {
  std::string name;
  std::vector<DeckPly> plies;  // from the negative face on
  /// Middle of the wall over the nodes along the facet's normal, in
  /// thicknesses.
  double offset = 0.0;
  /// Whose projection on a facet angles count from; needed for orthotropic
  /// plies.
  std::optional<Vec3> direction = {};
};

struct DeckNodeSet {
  std::string name;
  std::vector<int> nodes;  // from 0, ascending
};

/// Components that are held: displacements 1 2 3, rotations about 1 2 3.
struct DeckShellSupport {
  std::vector<int> nodes;  // from 0
  std::array<bool, 6> fixed = {};
  std::optional<Mat3> axes = {};  // unit vectors, one a column; else x y z
};

/// Nodes that move as one rigid body with `point`, a node of no facet, their
/// rotations too: of all steps.
struct DeckRigidBody {
  std::string name;
  int point = 0;           // from 0
  std::vector<int> nodes;  // the same
};

/// On a facet, positive along its normal [pressure].
struct DeckFacetPressure {
  int facet = 0;
  double pressure = 0.0;
};

/// One load case; nothing carries over from the step before.
struct DeckShellStep {
  std::string name;
  std::vector<DeckShellSupport> supports;
  VectorX held_at;       // 6 per node: displacement, rotation; or empty: 0
  VectorX nodal_forces;  // 6 per node: force, moment; or empty
  std::vector<DeckFacetPressure> pressures;
  Vec3 gravity = Vec3::Zero();  // force per mass [length/time^2]
  std::optional<io::DeckSpin> spin;
  double temperature_change = 0.0;  // of all nodes
  VectorX nodal_temperatures;       // changes beside it; may be empty

  double temperature_at(int node) const;
};

struct ShellDeck {
  std::vector<std::string> comments;  // case, units, version; one line each
  Points nodes;                       // [length]
  std::vector<std::array<int, 6>> facets;  // corners, middles (01) (12) (20)
  std::vector<int> section;                // one per facet
  std::vector<std::array<double, 6>> thickness;  // at each facet's nodes
  std::vector<DeckShellSection> sections;
  std::vector<DeckNodeSet> sets;  // films, rims
  std::vector<DeckRigidBody> rigid = {};
  std::vector<DeckShellStep> steps;
};

/// Throws InvalidInput, naming facet, node or step, for what is missing or does
/// not fit.
void check_shell_deck(const ShellDeck& deck);

/// One ply that is alike in all directions.
bool is_plain(const DeckShellSection& section);

/// The one thickness of a section's facets, where they have one.
std::optional<double> even_thickness(const ShellDeck& deck, int section);

/// Some step has a change of temperature.
bool is_heated(const ShellDeck& deck);

/// What a node's components are held at along its frame, or x y z without one.
std::array<double, 6> held_values(const DeckShellStep& step, int node,
                                  const std::optional<Mat3>& frame);

/// Three displacements, or rotations, held together are so along any axes.
bool needs_axes(const std::array<bool, 6>& fixed);

/// Axes of the nodes that a step holds along axes of their own. Throws
/// InvalidInput, naming step and node, where a deck cannot say it: a node has
/// one frame in all steps, and is held elsewhere along others only with all
/// three displacements, or rotations, together.
std::map<int, Mat3> turned_nodes(const ShellDeck& deck);

}  // namespace meniscus::shell_deck
