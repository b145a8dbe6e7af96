/// Are a datafile's bodies enclosed by their faces?
#pragma once

#include "evolve/datafile/fe_file.h"

namespace meniscus::datafile {

/// Throws InvalidInput with the body's place where two of its faces run along
/// their edge the same way, so that one is turned inside out, and where it ends
/// at an edge that nothing holds: its volume would mean nothing and the film go
/// astray. Bodies may be open along edges that are fixed, on constraints or on
/// boundaries, as by a wall or a mirror.
void check_fe_bodies(const FeFile& file);

}  // namespace meniscus::datafile
