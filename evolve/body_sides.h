/// Which side of its surfaces each body lies on.
#pragma once

#include "evolve/film_complex.h"

namespace meniscus {

/// Turns facets and sets BodySide::sign so that facets run outward of the
/// first body that lists their surface. Throws InvalidInput for a body that
/// its surfaces do not close (names the surfaces and a place), that can have
/// no outside, or that encloses no volume.
void orient_bodies(FilmComplex& complex);

/// The closed, outward surface of one body, with the complex's labels.
SurfaceMesh body_surface(const FilmComplex& complex, const ComplexBody& body);

}  // namespace meniscus
