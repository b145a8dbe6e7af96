/// Decks for CalculiX (and, but for the solver's name, Abaqus): a mesh with
/// its materials, supports and loads as a static job.
///
/// Nodes and elements are numbered from 1 in the mesh's order. Node sets are
/// named after the surfaces, element sets REGION_0 ...; CalculiX knows no
/// case and few characters, so names are written in capitals with '_' for the
/// rest, and the deck's head says which is which.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/tet_mesh.h"

namespace meniscus {

struct DeckMaterial {
  std::string name;
  double youngs_modulus = 0.0;  // [pressure]
  double poisson_ratio = 0.0;
  double density = 0.0;  // [mass/length^3]; 0: left out
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

/// One load case, one *STEP; nothing carries over from the step before.
struct DeckStep {
  std::string name;
  std::vector<DeckSupport> supports;
  VectorX nodal_forces;  // [force], 3 per node, written as *CLOAD; or empty
  std::vector<DeckPressure> pressures;
};

enum class DeckOutput {
  Viewer,  // .frd: displacement, reaction, stress
  Print,   // .dat: displacement of all nodes, sum of reactions, as text
  Both
};

struct CalculixDeck {
  std::vector<std::string> comments;    // case, units, version; one line each
  std::vector<DeckMaterial> materials;  // one per region
  std::vector<DeckStep> steps;
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
