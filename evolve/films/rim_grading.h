/// Edge lengths beside rims that are cut finer than their films.
#pragma once

#include <functional>

#include "evolve/films/film_complex.h"
#include "evolve/films/film_system.h"

namespace meniscus::films {

/// A curve that asks for short pieces, or of so many corners that they, not the
/// edge length, may decide how finely it is cut.
bool is_cut_finely(const curves::Curve& curve);

/// The length wanted at a place inside the closed polygon `rim`: `edge` far
/// from it, and beside a point of it the length of its own two pieces, growing
/// by 0.4 per distance. Empty when no piece is shorter than 0.6 x edge.
std::function<double(const Vec3&)> graded_edge(const Points& rim, double edge);

/// The same for a complex beside its rims on curves that are cut finely.
std::function<double(const Vec3&)> graded_edge(const FilmComplex& complex,
                                               double edge);

/// Does cutting the curves into pieces of `edge` x 2 and halving these end much
/// finer than cutting them into pieces of `edge`? So it is where sides are
/// shorter than edges.
bool halving_is_too_fine(const FilmSystem& system, double edge);

}  // namespace meniscus::films
