/// Are a datafile's bodies enclosed by their faces?
#pragma once

#include "evolve/fe_file.h"

namespace meniscus {

/// Throws InvalidInput with the body's place where two of its faces run along
/// their edge the same way, so that one is turned inside out, and where it ends
/// at an edge of a single face that nothing holds: the film would shrink away
/// from there and the volume mean nothing. Bodies may be open along edges that
/// are fixed, on constraints or on boundaries, as by a wall or a mirror.
void check_fe_bodies(const FeFile& file);

}  // namespace meniscus
