/// Internal: a Brep in a message between the program and `meniscus-step`.
#pragma once

#include "cad/solid/brep.h"
#include "core/frame.h"

namespace meniscus::step {

void put_brep(FrameWriter& out, const solid::Brep& brep);

/// The same bits. Throws IoError where the message ends before, or its numbers
/// point beyond its lists.
solid::Brep get_brep(FrameReader& in);

}  // namespace meniscus::step
