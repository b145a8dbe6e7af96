/// Junctions that no film keeps.
#pragma once

#include <optional>

#include "evolve/films/film_complex.h"

namespace meniscus::groom {

/// Films that are free to part meet three along a line and in four lines at a
/// point (Plateau; Taylor 1976). Any other junction is a saddle, however well
/// it has settled.
struct UnstableJunction {
  Vec3 place = Vec3::Zero();
  bool line = true;  // too many films along a line; else at a point
};

/// The first junction that pop_edges() or pop_vertices() would split; none in
/// a complex where at most two films meet along every edge.
std::optional<UnstableJunction> unstable_junction(
    const films::FilmComplex& complex);

}  // namespace meniscus::groom
