/// Shells as bulk data for Nastran: six-node CTRIA6 as SOL 101.
///
/// Grid points and elements are numbered from 1 in the deck's order; a PSHELL
/// and a MAT1 per section, whose facets have corner thicknesses of their own
/// where these follow the place, and ZOFFS where the wall lies beside the
/// nodes. RBE2 a rigid body. Nodes that are held along axes of their own have
/// these as their displacement frame (CORD2R). A SUBCASE per load case, a SET
/// per film and rim.
#pragma once

#include <filesystem>
#include <string>

#include "io/shell_deck/shell_deck.h"

namespace meniscus::shell_deck {

/// The file's text. Throws InvalidInput as check_shell_deck() and
/// turned_nodes() do.
std::string nastran_shell_bdf(const ShellDeck& deck);

/// The same into a file; IoError.
void write_nastran_shells(const std::filesystem::path& path,
                          const ShellDeck& deck);

}  // namespace meniscus::shell_deck
