/// A better place for the vertices that refinement makes.
#pragma once

#include "evolve/energy/film_space.h"
#include "evolve/groom/refine.h"

namespace meniscus::groom {

/// Moves the new free vertices of a refined, settled film from the middle of
/// their edge to that of a cubic with the film's normals at the edge's ends
/// (the edge curves of PN triangles: Vlachos et al. 2001), along lines with
/// the line's tangents. Where only one end has a smooth normal, a parabola.
/// The error falls from second to third or fourth order. `coarse`: of the
/// complex that was refined.
void bend_midpoints(const energy::FilmSpace& coarse,
                    const Points& coarse_points, Refinement& refinement);

}  // namespace meniscus::groom
