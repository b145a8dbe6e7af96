/// The points of a surface that move with a fillet's sections.
#pragma once

#include "evolve/fillets/fillet_bands.h"
#include "evolve/fillets/section_walk.h"

namespace meniscus::fillets {

/// Adds to the profiles of `bands`, whose sections are there, the inner points
/// of a side within the sections' length, each with its place between the two
/// sections next to it.
void add_followers(const LabelledFacets& facets, bool of_a, FilletBands& bands);

}  // namespace meniscus::fillets
