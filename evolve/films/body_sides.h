/// The bodies of a film system, and which side of its surfaces each lies on.
#pragma once

#include "evolve/films/film_complex.h"
#include "evolve/films/film_system.h"

namespace meniscus::films {

/// A body of surfaces by their number among the mesh's labels, all signs 1.
/// Throws InvalidInput that names what is wrong with its volume, its pressure
/// or a surface that it lists.
ComplexBody make_body(const BodySpec& body, const SurfaceMesh& mesh);

/// Throws InvalidInput unless a cap encloses a body.
void require_body(const FilmSystem& system, const std::string& cap);

/// Turns facets and sets BodySide::sign so that facets run outward of the
/// first body that lists their surface. Throws InvalidInput for a body that
/// its surfaces do not close (names the surfaces and a place), that can have
/// no outside, or that encloses no volume.
void orient_bodies(FilmComplex& complex);

/// The closed, outward surface of one body, with the complex's labels.
SurfaceMesh body_surface(const FilmComplex& complex, const ComplexBody& body);

}  // namespace meniscus::films
