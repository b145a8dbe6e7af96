/// Changes of topology, on explicit request only: grooming and equilibrium
/// never pop. After Surface Evolver's commands `t`, `pop` and `o` (Brakke,
/// Surface Evolver manual) and Plateau's laws: along lines three films meet,
/// at points four lines (Taylor 1976). All deterministic.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::groom {

struct PopReport {
  int popped = 0;
  Points places;    // of what was popped [length]
  int refused = 0;  // not minimal, but held, marked, on walls, or of a shape
                    // that is not known how to pop
};

/// Splits each line of four or more films into triple lines: the two
/// neighbouring films with the smallest angle between them are pulled off to a
/// line of their own, and a new narrow film joins the two lines, until three
/// films meet along each. The new film is a new surface ("popped1", ...) with
/// the tension of one that was pulled, between the bodies that it parts. Ends
/// of a line stay as they are.
PopReport pop_edges(films::FilmComplex& complex);

/// Pops vertices whose cone is none of the minimal ones (a disk, three half
/// disks, six sectors). Where sheets touch in the vertex only, as a pinched
/// neck does, each gets a vertex of its own. Otherwise a small ball around it
/// is given to the region with the largest solid angle: films then part that
/// from every other region. Lines of more than three films: pop_edges first.
PopReport pop_vertices(films::FilmComplex& complex);

/// Removes edges shorter than `length` [length, >= 0], the shortest first,
/// with their facets, even where that pinches a neck; not where a facet would
/// be there twice or something held would move. Returns how many.
int collapse_tiny_edges(films::FilmComplex& complex, double length);

}  // namespace meniscus::groom
