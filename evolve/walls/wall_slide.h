/// A sheet's points slid along it, away from its junctions.
#pragma once

#include <map>
#include <vector>

#include "evolve/walls/sheet.h"

namespace meniscus::walls {

struct SlideInput {
  const Sheet& sheet;
  std::vector<char> held;  // per point: it is on a junction
  // By wall, what it makes these slide along the sheet [length]; 0 elsewhere.
  std::map<int, Points> slides;
  // Where nothing slides any more, at least so far from the junctions
  // [length]; above the largest slide, so that nothing folds.
  double reach = 0.0;
};

struct Slides {
  std::map<int, Points> by;  // by wall, per point [length]
  std::vector<double> way;   // from the junctions along edges, at most `reach`
};

/// Per point how far it slides: harmonic on the sheet between its junctions
/// and `reach` from these, so that facets keep their order also where it is
/// narrow or has corners; along the rim where the sheet ends on one.
Slides slide(const SlideInput& input);

}  // namespace meniscus::walls
