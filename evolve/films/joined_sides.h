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

/// A held corner at which a line begins or ends, and the nearest place where
/// a film that is joined is held; or a free one at which it passes from a film
/// to the next, and the nearest place of a curve that holds both.
struct JoinEnd {
  int film = 0;           // that joins
  Vec3 place;             // of the corner
  bool held = true;       // the corner
  int curve = -1;         // of the joined film, index; -1: it has none
  double t = 0.0;         // on it; of a corner that is within reach
  double distance = 0.0;  // [length]
  bool meets = false;     // within reach
};

/// How far from a curve a line may be drawn that ends on it: 1e-4 of its length
/// [length].
double join_reach(const curves::Curve& curve);

std::vector<JoinEnd> join_ends(const FilmSystem& system);

/// Films that join others (indices), each after those that it joins; without
/// those that join each other in a circle.
std::vector<int> joining_order(const std::vector<FilmSpec>& films);

/// Do curves a and b (indices) belong to films of which one joins the other, or
/// that both join others? They may meet.
bool may_meet(const FilmSystem& system, int a, int b);

}  // namespace meniscus::films
