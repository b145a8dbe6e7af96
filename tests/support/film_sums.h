/// Plain sums over a film complex, written apart from the engine: what a
/// datafile's complex must add up to.
#pragma once

#include "evolve/films/film_complex.h"

namespace meniscus::sums {

double area(const films::FilmComplex& complex);  // of all facets [length^2]

/// Tension times area, weight of bodies, line integrals with five Gauss
/// points an edge, quantities that are energies.
double energy(const films::FilmComplex& complex);

double volume(const films::FilmComplex& complex, int body);  // content included

/// Value of quantity `index` without its modulus.
double quantity(const films::FilmComplex& complex, int index);

int edges(const films::FilmComplex& complex);  // of facets, each once

}  // namespace meniscus::sums
