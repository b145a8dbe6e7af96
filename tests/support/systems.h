/// Named film systems that the tests of evolve share.
#pragma once

#include "evolve/films/film_complex.h"

namespace meniscus::systems {

/// Circles of radius 35 and twice 50; one branch film, three caps, one body.
films::FilmSystem bracket();

/// Two unit circles at z = -0.5 and 0.5 and the film between; no body.
films::FilmSystem catenoid();

/// Unit circles `length` apart, film, caps, one body.
films::FilmSystem cylinder(double length);

/// Square of side 2 at z = 0 to a circle r = 0.6 at (0.8, 0, 4), capped.
films::FilmSystem strut();

/// Two chambers on one axis that share a disk film (a bulkhead).
films::FilmSystem bulkhead();

struct Quality {
  double smallest_angle = 0.0;        // [deg] of all facets counted
  double smallest_inner_angle = 0.0;  // [deg] of facets without a curve vertex
  double shortest = 0.0;              // edges [length]
  double longest = 0.0;
  double mean = 0.0;
};

/// Of the facets with liquid surfaces, or of those of caps.
enum class Part { Films, Caps };
Quality quality(const films::FilmComplex& complex, Part part);

/// Vertices - edges + facets of what is used.
int euler_characteristic(const SurfaceMesh& mesh);

/// Edges with one facet.
int open_edges(const SurfaceMesh& mesh);

/// Of all facets [deg].
double smallest_angle_deg(const SurfaceMesh& mesh);

/// Equal in every bit.
bool identical(const films::FilmComplex& a, const films::FilmComplex& b);

}  // namespace meniscus::systems
