/// Where the pops of an unstable junction lead. At which of several films at
/// rest a film ends that pops depends on what popped when; Surface Evolver's
/// users find a good one by trial. Here the trials are made for them.
#pragma once

#include <vector>

#include "core/monitor.h"
#include "evolve/films/film_complex.h"

namespace meniscus::settle {

struct PopSearchOptions {
  int width = 8;         // films kept from round to round, >= 1
  int most_rounds = 12;  // >= 1
  int patience = 4;      // rounds without a lower film that end the search
  int steps = 20;        // of conjugate gradients between pops
  int most_found = 3;    // films returned
  // What is done at most, in facets x films; large films are searched narrowly.
  double most_work = 2e5;
  Monitor* monitor = nullptr;
};

struct PoppedFilm {
  films::FilmComplex complex;
  double energy = 0.0;  // near rest, at the targets' volumes
  int popped = 0;       // junctions
};

/// Films reached from any of `starts` by pops (pop_edges, pop_vertices), short
/// motions downhill, and between them edges shorter than 0.04 or 0.12 of the
/// start's mean edge collapsed, or not, and diagonals flipped, or not: a beam
/// search over such histories that keeps the lowest films. Deterministic.
/// Returns the lowest few with nothing left to pop, the lowest first; none
/// where no history ends. Throws Interrupted.
std::vector<PoppedFilm> search_pops(
    const std::vector<films::FilmComplex>& starts,
    const PopSearchOptions& options);

}  // namespace meniscus::settle
