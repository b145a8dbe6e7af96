/// One film at several resolutions: coarse for analysis, finer for printing,
/// finest for lofting.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"
#include "evolve/frozen/film_model.h"

namespace meniscus::frozen {

struct FilmResolution {
  double edge = 0.0;           // asked for [length]
  films::FilmComplex complex;  // its film, settled
  settle::FilmState
      state;  // report and verdict; failure when it did not settle
};

/// The film at another edge length [length, > 0]: refined until its edges are
/// at most 1.4 times as long, new vertices bent to where the film runs, then
/// remeshed and settled. Curves, walls, triple lines, labels and targets are
/// kept; vertices on curves are halved only, so that rims keep their edges
/// where `edge` is longer. A pure function of its arguments. Throws
/// InvalidInput for an edge that is not above 0, or so short that more than
/// 10^7 facets would come out, and Interrupted.
FilmResolution at_edge(const films::FilmComplex& settled, double edge,
                       const settle::SettleOptions& options = {});

/// The same for each of `edges`, independent of each other.
std::vector<FilmResolution> at_edges(const films::FilmComplex& settled,
                                     const std::vector<double>& edges,
                                     const settle::SettleOptions& options = {});

}  // namespace meniscus::frozen
