/// Decks for CalculiX (and, but for the solver's name, Abaqus): a mesh with
/// its materials, supports and loads as a static job.
///
/// Nodes and elements are numbered from 1 in the mesh's order. Node sets are
/// named after the surfaces, element sets REGION_0 ...; CalculiX knows no
/// case and few characters, so names are written in capitals with '_' for the
/// rest, and the deck's head says which is which. Pressures are *DLOAD, nodal
/// forces *CLOAD; springs are SPRING1 elements on nodes of their own, tied to
/// the mesh by *EQUATION, that are held to the ground in the steps where they
/// act; equations act in all steps, and so do rigid pins, each two nodes more
/// (translations and rotations) with equations for its nodes.
#pragma once

#include <filesystem>
#include <string>

#include "io/analysis_deck.h"

namespace meniscus::io {

enum class DeckOutput {
  Viewer,  // .frd: displacement, reaction, stress
  Print,   // .dat: displacement of all nodes, sum of reactions, stresses at
           // integration points, as text
  Both,
  Nothing  // to time the solution alone
};

struct CalculixDeck : AnalysisDeck {
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

}  // namespace meniscus::io
