/// From a film complex to a Surface Evolver datafile.
#pragma once

#include <string>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::datafile {

/// Text that Surface Evolver 2.70 loads with the same counts and the same
/// energy (12 digits), and read_fe() too. Elements are numbered from 1 in the
/// complex's order, edges in that of list_edges(). Circles, ellipses and
/// parametric curves become boundaries; on rectangles and polygons vertices
/// and edges are written as fixed. Vertices inside caps are written as fixed.
///
/// `comments`: lines at the head.
///
/// Throws InvalidInput for what a datafile cannot say: gravity that does not
/// point down, vertices that slide on rectangles or polygons, a held quantity
/// over one body's volume, an expression nested too deep.
std::string fe_text(const films::FilmComplex& complex,
                    const std::vector<std::string>& comments = {});

}  // namespace meniscus::datafile
