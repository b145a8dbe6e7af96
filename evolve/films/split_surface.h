/// Solid and liquid regions: parts of a film with another state of their own.
#pragma once

#include <string>

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// What a region of a film becomes.
struct Region {
  std::string name;                         // of its new surface
  bool liquid = true;                       // false: solid, stays where it is
  double tension = 0.0;                     // [force/length], liquid only; > 0
  std::optional<Expression> tension_field;  // over x, y, z; replaces tension
};

/// Moves the facets of `surface` at whose centre `where` > 0 (over x, y, z)
/// into a new surface, which bodies and quantities take over from it. Returns
/// its index. Vertices of a solid region become Fixed, also those that liquid
/// facets share, which then hold on to it. Edges between the regions become
/// marked edges, so that refinement and remeshing keep the border. Between two
/// liquid regions the border is carried along with the film: films move along
/// their normals, and the step of tension across it pulls along the film only.
/// Throws InvalidInput: no such surface or a solid one, a name in use, a
/// tension not above 0, no facet or every facet in the region, an expression
/// without a value at a facet.
int split_surface(FilmComplex& complex, const std::string& surface,
                  const Expression& where, const Region& region);

}  // namespace meniscus::films
