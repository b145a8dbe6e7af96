/// Internal to film_solid: a film that is a cylinder or a sphere as one face.
#pragma once

#include <string>
#include <vector>

#include "cad/solid/film_mesh.h"
#include "cad/solid/film_solid.h"
#include "cad/solid/rim_edges.h"
#include "cad/solid/simple_film.h"

namespace meniscus::solid {

struct TurnedFilm {
  std::string name;
  SimpleFilm shape;       // no plane
  std::vector<int> rims;  // of the solid, that its own rims are
  FilmMesh mesh;
};

/// Asks the rims for vertices at the ends of its seam.
void want_seam(const TurnedFilm& film, std::vector<RimEdges>& rims);

/// Adds its seam, its poles and its face; the rims are built.
void add_turned_face(const TurnedFilm& film, const std::vector<RimEdges>& rims,
                     Brep& brep);

/// Adds its distances, both ways, to the report.
void measure_turned(const TurnedFilm& film, FilmSolidReport& report);

}  // namespace meniscus::solid
