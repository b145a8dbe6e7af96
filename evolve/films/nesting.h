/// Do the films of one complex keep apart, how far, and which lies in which?
#pragma once

#include <string>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// Two facets that cross; film and other may be the same.
struct FilmCrossing {
  std::string film;
  std::string other;
  std::array<int, 2> facets = {-1, -1};
  Vec3 position = Vec3::Zero();
};

/// The shortest line between two groups; zero where they cross.
struct GroupGap {
  std::string group;
  std::string other;
  double gap = 0.0;  // [length]
  Vec3 on_group = Vec3::Zero();
  Vec3 on_other = Vec3::Zero();
};

struct GroupInside {
  std::string inner;
  std::string outer;
};

/// A group is facets that hang together; it has the name of its film, of
/// several "'a' and 2 more", and a second group of that name "'a' (2)".
struct NestingReport {
  bool apart = true;       // no two facets of the films cross
  int crossing_pairs = 0;  // of facets; the first are listed
  std::vector<FilmCrossing> crossings;
  std::vector<GroupGap> gaps;  // one per pair of groups
  std::vector<GroupInside>
      inside;                      // every pair, one of which lies in the other
  std::vector<std::string> order;  // inside out; side by side as labelled
};

struct NestingOptions {
  int max_crossings = 20;  // listed
  int max_groups = 50;     // of more, gaps and order are left out
};

/// Of the surfaces `films` (indices of labels; empty: all). No two facets
/// crossing, judged by orientation signs in extended precision
/// (core/geometry/facet_pairs.h), says that the triangulated films do not
/// cross; it says nothing of smooth films closer than the facets' sagitta,
/// about edge^2 / (8 radius): compare with the gap.
///
/// A group is inside another when more than half of its area is, by the parity
/// of rays; open films are closed by fans across their rims. Throws MeshError
/// for labels, corners or points that are not sound. O(n log n) for groups at
/// a distance.
NestingReport check_nesting(const SurfaceMesh& mesh,
                            const std::vector<int>& films = {},
                            const NestingOptions& options = {});

/// The report in a line for people, with names and places; empty for one group
/// that does not cross itself. `length_unit` follows the gap.
std::string nesting_text(const NestingReport& report,
                         const std::string& length_unit = "");

}  // namespace meniscus::films
