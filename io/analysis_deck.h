/// A meshed part as a static job for another solver: materials, supports,
/// loads. What the writers of decks (CalculiX, Nastran) are given.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"

namespace meniscus::io {

/// Engineering constants in axes of their own: axis 1, and one in the plane of
/// 1 and 2.
struct DeckOrthotropic {
  Vec3 youngs_moduli = Vec3::Zero();   // 1, 2, 3 [pressure]
  Vec3 poisson_ratios = Vec3::Zero();  // 12, 13, 23
  Vec3 shear_moduli = Vec3::Zero();    // 12, 13, 23 [pressure]
  Vec3 axis_1 = Vec3::UnitX();
  Vec3 axis_2 = Vec3::UnitY();
};

struct DeckMaterial {
  std::string name;
  double youngs_modulus = 0.0;  // [pressure]
  double poisson_ratio = 0.0;
  double density = 0.0;                        // [mass/length^3]; 0: left out
  std::optional<DeckOrthotropic> orthotropic;  // instead of the modulus
  Vec3 thermal_expansion = Vec3::Zero();       // [1/temperature]; 0: left out
};

/// Displacement components that are held.
struct DeckSupport {
  std::string surface;     // its nodes; or, when empty, these:
  std::vector<int> nodes;  // from 0
  bool fix_x = false, fix_y = false, fix_z = false;
  Vec3 displacement = Vec3::Zero();  // what these are held at [length]
};

/// Nodes that move as one rigid body in all steps.
struct DeckPin {
  std::vector<int> nodes;        // from 0
  Vec3 point = Vec3::Zero();     // whose displacement its translation is
  Mat3 axes = Mat3::Identity();  // of its motions, one a column
};

/// Motions of a pin that a step holds: three translations, three rotations.
struct DeckPinSupport {
  std::array<bool, 6> fixed = {};
  std::array<double, 6> value = {};  // [length], [rad]
};

/// On element faces, positive into the solid [pressure].
struct DeckPressure {
  std::string surface;
  double pressure = 0.0;
};

/// Centrifugal force.
struct DeckSpin {
  Vec3 point = Vec3::Zero();  // on the axis [length]
  Vec3 axis = Vec3::UnitZ();
  double rate = 0.0;  // [rad/time]
};

/// coefficients . u = 0 at a node, solved for component `dependent`, which no
/// support and no other equation holds. Equations act in all steps.
struct DeckEquation {
  int node = 0;  // from 0
  Vec3 coefficients = Vec3::Zero();
  int dependent = 0;
};

/// Springs of one stiffness: each pulls with stiffness x e on
/// e = sum coefficients . u over its nodes, in the steps where they act.
struct DeckSprings {
  double stiffness = 0.0;  // above 0
  struct Spring {
    std::vector<int> nodes;  // of the mesh, from 0
    Points coefficients;     // one per node, not all 0
  };
  std::vector<Spring> springs;
  std::vector<int> steps;  // where they act, from 0
};

/// One load case; nothing carries over from the step before.
struct DeckStep {
  std::string name;
  std::vector<DeckSupport> supports;
  VectorX nodal_forces;  // [force], 3 per node, or empty
  std::vector<DeckPressure> pressures;
  Vec3 gravity = Vec3::Zero();  // force per mass [length/time^2]
  std::optional<DeckSpin> spin;
  VectorX temperature_change;        // one per node, or empty [temperature]
  std::vector<DeckPinSupport> pins;  // one per pin of the deck
};

struct AnalysisDeck {
  std::vector<std::string> comments;    // case, units, version; one line each
  std::vector<DeckMaterial> materials;  // one per region
  std::vector<DeckStep> steps;
  std::vector<DeckEquation> equations;
  std::vector<DeckSprings> springs;
  std::vector<DeckPin> pins;
};

/// Throws InvalidInput, naming surface, region or step, for what is missing or
/// does not fit the mesh.
void check_deck(const TetMesh& mesh, const AnalysisDeck& deck);

/// The springs act in the step, counted from 0.
bool acts_in(const DeckSprings& springs, std::size_t step);

/// Nodes of a surface, ascending; `label` as in mesh.labels.
std::vector<int> deck_surface_nodes(const TetMesh& mesh, int label);

/// Label of a surface that a step names. Throws InvalidInput for one that the
/// mesh has not.
int surface_of_step(const TetMesh& mesh, const std::string& surface,
                    const DeckStep& step);

/// The nodes that a support holds.
std::vector<int> supported_nodes(const TetMesh& mesh,
                                 const DeckSupport& support,
                                 const DeckStep& step);

/// Local number, 0 to 3, of the corner of the element behind a boundary face
/// that the face has not. Throws MeshError for a face of another element.
int corner_off_face(const TetMesh& mesh, int face);

}  // namespace meniscus::io
