/// Films that start from facets of their own, put onto the curves that hold
/// them.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "evolve/films/film_system.h"

namespace meniscus::start {

/// Where a facet's corner is: a cut of a curve, or else a point.
struct FacetCorner {
  int point = -1;  // index into FacetStart::points; -1: on a curve
  int curve = -1;  // index into FilmSystem::curves
  int cut = -1;    // which of the curve's cuts
};

struct FacetSheet {
  std::string name;
  std::vector<std::array<FacetCorner, 3>> facets;
};

struct FacetStart {
  Points points;
  std::vector<FacetSheet> sheets;           // of films, then of solids
  std::map<int, std::vector<double>> cuts;  // by curve: increasing parameters
};

/// All films and solids of a system that have facets. Points of different ones
/// at one place are one point, so that films join where they share edges.
/// Every other edge with one facet is a rim and must lie on a curve that its
/// film names. Such a curve is cut where the rims on it have their vertices, at
/// its corners and, unless `keep`, into pieces of about `edge` [length]; facets
/// on it are cut with it.
///
/// Throws InvalidInput, naming film and place: a corner that is no vertex, a
/// facet without area, three facets at an edge of one film, a rim that lies on
/// no curve (how far the nearest is), a curve without a rim, a rim that folds
/// back.
FacetStart start_from_facets(const films::FilmSystem& system, double edge,
                             bool keep);

/// The mean edge of those facets [length]; 0 where there are none.
double mean_facet_edge(const films::FilmSystem& system);

}  // namespace meniscus::start
