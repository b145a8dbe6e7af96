/// Internal to cut_film: a film with one rim, or none, as four-sided cells.
#pragma once

#include "cad/solid/film_splitter.h"

namespace meniscus::solid {

constexpr int kDiskCells = 5;
constexpr int kClosedCells = 6;

/// One rim with four corners.
bool is_four_sided(const std::vector<FilmRim>& rims);
/// Such a film as one patch.
FilmPatch whole_patch(const SplitFilm& split);

/// The vertex of a loop at a place of its rim, or the one next to it.
int rim_vertex(const SplitFilm& split, const std::vector<int>& loop,
               double place);

/// The film refined and cut. One rim of four corners: not cut. Another: by its
/// harmonic map onto a disk (one to one: Radó 1926), into a square in the
/// middle, cell 0, and the four parts between the square's sides and the rim,
/// whose corners lie on those lines where it has any. No rim: by directions
/// from its middle, as a cube's sides. Throws MeshError for one rim of a film
/// that is no disk, and for none of one that its middle does not see all of.
SplitFilm film_cells(FilmMesh mesh, const std::vector<FilmRim>& rims);

/// Cuts between cells are drawn to facets' corners, and bend at random within a
/// facet of the nodes where they meet: each node moves to where its lines meet
/// as they come from beyond that, along the film, and they run straight to it.
void straighten_nodes(CutFilm& film);

}  // namespace meniscus::solid
