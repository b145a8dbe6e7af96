/// Decks for CalculiX (and, but for the solver's name, Abaqus): a mesh with
/// its materials, supports and loads as a static job.
///
/// Nodes and elements are numbered from 1 in the mesh's order. Node sets are
/// named after the surfaces, element sets REGION_0 ...; CalculiX knows no
/// case and few characters, so names are written in capitals with '_' for the
/// rest, and the deck's head says which is which.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/tet_mesh.h"

namespace meniscus {

/// CalculiX's ENGINEERING CONSTANTS, in axes of their own: axis 1, and one in
/// the plane of 1 and 2.
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

/// Displacement components held at zero.
struct DeckSupport {
  std::string surface;     // its nodes; or, when empty, these:
  std::vector<int> nodes;  // from 0
  bool fix_x = false, fix_y = false, fix_z = false;
};

/// Written as *DLOAD on element faces, positive into the solid [pressure].
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
/// e = sum coefficients . u over its nodes. Written as SPRING1 elements on
/// nodes of their own, tied to the mesh by *EQUATION, that are held to the
/// ground in the steps where they act.
struct DeckSprings {
  double stiffness = 0.0;  // above 0
  struct Spring {
    std::vector<int> nodes;  // of the mesh, from 0
    Points coefficients;     // one per node, not all 0
  };
  std::vector<Spring> springs;
  std::vector<int> steps;  // where they act, from 0
};

/// One load case, one *STEP; nothing carries over from the step before.
struct DeckStep {
  std::string name;
  std::vector<DeckSupport> supports;
  VectorX nodal_forces;  // [force], 3 per node, written as *CLOAD; or empty
  std::vector<DeckPressure> pressures;
  Vec3 gravity = Vec3::Zero();  // force per mass [length/time^2]
  std::optional<DeckSpin> spin;
  VectorX temperature_change;  // one per node, or empty [temperature]
};

enum class DeckOutput {
  Viewer,  // .frd: displacement, reaction, stress
  Print,   // .dat: displacement of all nodes, sum of reactions, stresses at
           // integration points, as text
  Both,
  Nothing  // to time the solution alone
};

struct CalculixDeck {
  std::vector<std::string> comments;    // case, units, version; one line each
  std::vector<DeckMaterial> materials;  // one per region
  std::vector<DeckStep> steps;
  std::vector<DeckEquation> equations;
  std::vector<DeckSprings> springs;
  std::string solver = "SPOOLES";  // or "ITERATIVE CHOLESKY", ...
  DeckOutput output = DeckOutput::Both;
};

/// The deck's text. Throws InvalidInput, naming surface, region or step, for
/// what is missing or does not fit.
std::string calculix_deck(const TetMesh& mesh, const CalculixDeck& deck);

/// The same into a file; IoError.
void write_calculix_inp(const std::filesystem::path& path, const TetMesh& mesh,
                        const CalculixDeck& deck);

/// CalculiX's number, 1 to 4, of the element face opposite the local corner
/// 0 to 3: faces are 1-2-3, 1-4-2, 2-4-3, 3-4-1.
int calculix_face(int opposite_corner);

}  // namespace meniscus
