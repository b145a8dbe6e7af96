/// Internal to cut_film: a film with one rim, or none, as four-sided cells.
#pragma once

#include "cad/solid/film_splitter.h"

namespace meniscus::solid {

constexpr int kDiskCells = 5;
constexpr int kClosedCells = 6;

/// The film refined and cut. One rim: by its harmonic map onto a disk (one to
/// one: Radó 1926), into a square in the middle, cell 0, and the four parts
/// between the square's sides and the rim, whose corners lie on those lines
/// where it has any. No rim: by directions from its middle, as a cube's sides.
/// Throws MeshError for one rim of a film that is no disk, and for none of one
/// that its middle does not see all of.
SplitFilm film_cells(FilmMesh mesh, const std::vector<FilmRim>& rims);

}  // namespace meniscus::solid
