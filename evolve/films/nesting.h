/// Do the films of one complex keep apart, how far, and which lies in which?
#pragma once

#include <string>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// Two facets that cross; film and other may be the same.
struct FilmCrossing {
  std::string film;
  std::string other;
  std::array<int, 2> facets = {-1, -1};
  Vec3 position = Vec3::Zero();
};

/// The shortest line between two films. Zero where they cross or share a
/// vertex (`joined`).
struct FilmGap {
  std::string film;
  std::string other;
  double gap = 0.0;  // [length]
  bool joined = false;
  Vec3 on_film = Vec3::Zero();
  Vec3 on_other = Vec3::Zero();
};

struct FilmInside {
  std::string inner;
  std::string outer;
};

struct NestingReport {
  bool apart = true;       // no two facets of the films cross
  int crossing_pairs = 0;  // of facets; the first are listed
  std::vector<FilmCrossing> crossings;
  std::vector<FilmGap> gaps;       // one per pair of films
  std::vector<FilmInside> inside;  // every pair of which one lies in the other
  std::vector<std::string> order;  // inside out; films side by side as labelled
  std::string verdict;             // in words, with names and places
};

struct NestingOptions {
  int max_crossings = 20;  // listed
};

/// Of the surfaces `films` (indices of labels; empty: all). No two facets
/// crossing, judged by orientation signs in extended precision
/// (core/geometry/facet_pairs.h), proves that the triangulated films do not
/// cross; it says nothing of smooth films closer than the facets' sagitta,
/// about edge^2 / (8 radius): compare with the gap.
///
/// A film is inside another when more than half of its area is, by the parity
/// of rays; open films are closed by fans across their rims. Throws MeshError
/// for labels, corners or points that are not sound. O(n log n) for films at a
/// distance.
NestingReport check_nesting(const SurfaceMesh& mesh,
                            const std::vector<int>& films = {},
                            const NestingOptions& options = {});

/// Of the liquid surfaces.
NestingReport check_nesting(const FilmComplex& complex,
                            const NestingOptions& options = {});

}  // namespace meniscus::films
