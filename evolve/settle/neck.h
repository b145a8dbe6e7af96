/// How near films come to each other across a body.
#pragma once

#include "evolve/energy/energy.h"

namespace meniscus::settle {

struct Neck {
  double width = 0.0;            // [length]; 0 when no ray hits a film
  Vec3 position = Vec3::Zero();  // middle of the narrowest line
  int surface = -1;              // of the film it starts from
  int opposite = -1;             // of the film it ends at
};

/// The shortest of the lines that start at a film vertex, run along the
/// inward normal into the body (both ways for a film that encloses nothing)
/// and end at a film of the same body that faces them. Lines that end at a
/// solid cap do not count, nor those from a film to another that it hangs
/// together with nowhere: nested films have a gap
/// (evolve/frozen/gap_between.h), and do not pinch. O(n log n); deterministic.
Neck narrowest_neck(const energy::FilmEnergy& energy, const Points& points,
                    const std::vector<int>& facet_label);

}  // namespace meniscus::settle
