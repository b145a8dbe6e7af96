/// Where films end on others that nobody cut (FilmSpec::joins).
#pragma once

#include <vector>

#include "evolve/films/film_system.h"

namespace meniscus::films {

struct JoinedSide {
  int film = 0;   // index into FilmSystem::films
  int curve = 0;  // index into FilmSystem::curves
  int side = -1;  // of a polygon or polyline; -1: the whole curve
};

/// The free sides and curves of films that join others, but for those at which
/// another film or a solid ends too: lines of a junction that has them all.
std::vector<JoinedSide> joined_sides(const FilmSystem& system);

/// Do curves a and b (indices) belong to films of which one joins the other, or
/// that both join others? They may meet.
bool may_meet(const FilmSystem& system, int a, int b);

}  // namespace meniscus::films
