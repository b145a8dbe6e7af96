/// Internal to film_solid: one film as faces of a solid.
#pragma once

#include <string>
#include <vector>

#include "cad/solid/cut_film.h"
#include "cad/solid/film_knots.h"
#include "cad/solid/fit_patch.h"
#include "cad/solid/rim_edges.h"

namespace meniscus::solid {

/// A film that has been cut; the solid's rims that its own rims are.
struct FilmPiece {
  std::string name;
  CutFilm cut;
  std::vector<int> rims;
  std::vector<int> facets;  // of the whole mesh
};

/// Where a film's patches have become faces.
struct FilmFaces {
  std::vector<FittedPatch> patches;
  int first_face = 0;  // in the solid, one per patch
};

/// Asks the rims for vertices at the patches' corners.
void want_corners(const FilmPiece& film, std::vector<RimEdges>& rims);

/// Adds vertices, edges and faces of the film; the rims are built.
FilmFaces add_faces(const FilmPiece& film, const std::vector<RimEdges>& rims,
                    const FaceLimits& limits, Brep& brep);

/// The point of the unit square at `share` of side 0 to 3, which run from a to
/// b, counter-clockwise from the bottom.
Vec2 on_side(int side, double share);

}  // namespace meniscus::solid
