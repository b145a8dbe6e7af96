/// Decks of shells for CalculiX and Abaqus: six-node S6 elements as a static
/// job.
///
/// Nodes and elements are numbered from 1 in the deck's order. Node sets are
/// named after films and rims, element sets SHELL_0 ... after the sections;
/// names as in calculix_inp.h. A section of one thickness has it, others take
/// *NODAL THICKNESS. Nodes that are held along axes of their own, or whose
/// rotations are held in part, have frames by *TRANSFORM
/// (calculix_shell_held.h).
///
/// CalculiX makes wedges of S6 and ties a node to the middle of the wall, also
/// where OFFSET puts the wall beside the nodes: what holds the node holds the
/// middle, displacements are the middle's, and a force on a node that is not
/// held is given with its moment about the middle, in a frame along the wall's
/// normal.
#pragma once

#include <filesystem>
#include <string>

#include "io/shell_deck/shell_deck.h"

namespace meniscus::shell_deck {

/// The deck's text. Throws InvalidInput as check_shell_deck() and
/// held_shell_nodes() do, for rigid bodies, which CalculiX's couplings do not
/// have of nodes that turn along, and for two sections whose thicknesses follow
/// the place and differ at a node.
std::string calculix_shell_deck(const ShellDeck& deck);

/// The same into a file; IoError.
void write_calculix_shells(const std::filesystem::path& path,
                           const ShellDeck& deck);

}  // namespace meniscus::shell_deck
