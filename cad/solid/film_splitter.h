/// Internal to cut_film: new vertices on edges of a film.
#pragma once

#include <set>

#include "cad/solid/cut_film.h"

namespace meniscus::solid {

/// What is cut, with the tube and the sector of each facet and the values of
/// a function at its corners.
struct SplitFilm {
  CutFilm film;
  const std::vector<FilmRim>* rims = nullptr;
  std::set<Edge> rim_edges;                  // lower vertex first
  std::vector<int> cell;                     // per facet
  std::vector<int> sector;                   // per facet
  std::vector<std::array<double, 3>> value;  // per facet corner
};

/// The film refined until its cuts can be smooth, however coarse it is: new
/// vertices on the smooth film and on the rims' curves. One cell.
SplitFilm refined_film(FilmMesh mesh, const std::vector<FilmRim>& rims);

/// A vertex on the edge from a to b at share t; on a rim's edge it lies on the
/// rim's curve. `facets` stay as they are.
int add_vertex(SplitFilm& split, int a, int b, double t);

/// Cuts the film by the greatest of `measures` (a column per cell); sets
/// `cell`. Where three meet a vertex is added. Returns those vertices.
std::vector<int> split_by_greatest(SplitFilm& split,
                                   const Eigen::MatrixXd& measures);

/// Cuts the facets of one cell along value = level, modulo 1. `kept`: vertices
/// (one char each) that the line must not be drawn to.
void split_by_level(SplitFilm& split, int cell, double level,
                    const std::vector<char>& kept);

}  // namespace meniscus::solid
