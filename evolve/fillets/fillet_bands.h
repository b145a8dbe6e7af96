/// What a fillet is frozen with: sections across its curve, and the points
/// beside it that move with them.
#pragma once

#include <string>
#include <vector>

#include "evolve/fillets/section_walk.h"
#include "evolve/films/film_system.h"

namespace meniscus::fillets {

/// A point beside the curve: it moves as the point at `s` of a section would,
/// times weight, with one side's section.
struct Follower {
  int point = 0;
  bool of_a = true;
  double s = 0.0;  // of the section [length]
  double weight = 0.0;
};

/// The sections at one point of the curve.
struct Profile {
  int point = 0;
  int before = 0;  // on the curve
  int after = 0;
  std::array<Mean, 3> a = {};  // at 1/3, 2/3 and 1 of the sections' lengths
  std::array<Mean, 3> b = {};
  double arc_a = 0.0;  // of the sections: what the arc takes [length]
  double arc_b = 0.0;
  std::vector<Follower> followers = {};
};

/// Side a is the film's; b the other surface's.
struct FilletBands {
  std::string name;       // the fillet's
  std::string curve;      // its curve's
  double length_a = 0.0;  // of the sections [length]
  double length_b = 0.0;
  double out_a = 1.0;  // outward normals: out x (along x inward)
  double out_b = 1.0;
  /// Where the curve goes, as a share of the arc: a solid's face ends at the
  /// arc's beginning, so that all of it is the film's; two films share it.
  double share = 0.0;
  std::vector<Profile> profiles;  // in order around the curve
};

/// Of radius 0: no profiles.
/// Of a closed surface, outward; `rims`: points on the curves of all fillets,
/// `which` of them is the one to make. Throws InvalidInput, with the place, for
/// a curve where no film meets another surface, one with corners, one where
/// more than two surfaces meet, and a radius that does not fit.
FilletBands freeze_bands(const SurfaceMesh& surface,
                         const films::FilmSystem& system,
                         const std::vector<std::vector<int>>& rims,
                         std::size_t which);

}  // namespace meniscus::fillets
