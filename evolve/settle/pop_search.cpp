#include "evolve/settle/pop_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "evolve/energy/energy.h"
#include "evolve/groom/flip_average.h"
#include "evolve/groom/pop.h"
#include "evolve/settle/descent.h"

namespace meniscus::settle {

namespace {

// x mean edge of the start.
constexpr std::array<double, 3> kCollapsed = {0.0, 0.04, 0.12};
// Relative difference of energies below which two films count as one.
constexpr double kSameFilm = 1e-7;

struct Candidate {
  PoppedFilm film;
  double mean_edge = 0.0;  // of the start [length]
};

double mean_edge_of(const films::FilmComplex& complex) {
  return energy::FilmEnergy(complex, energy::FilmMotion::Anywhere)
      .mean_edge(complex.mesh.points);
}

int pop_all(films::FilmComplex& complex) {
  const int edges = groom::pop_edges(complex).popped;
  return edges + groom::pop_vertices(complex).popped;
}

/// Pops and relaxes `candidate`.
void advance(Candidate& candidate, const PopSearchOptions& options) {
  films::FilmComplex& complex = candidate.film.complex;
  candidate.film.popped += pop_all(complex);
  const energy::FilmEnergy energy(complex, energy::FilmMotion::Anywhere);
  Points& points = complex.mesh.points;
  const DescentReport down =
      descend(energy, energy::targets_of(complex),
              energy.space().directions(points), points,
              {.method = DescentMethod::ConjugateGradients,
               .max_steps = options.steps,
               .monitor = options.monitor});
  candidate.film.energy = down.energies.back();
}

/// The lowest `most`, each film once.
void keep_lowest(std::vector<Candidate>& films, std::size_t most) {
  std::stable_sort(films.begin(), films.end(),
                   [](const auto& a, const auto& b) {
                     return a.film.energy < b.film.energy;
                   });
  const auto same = [](const Candidate& a, const Candidate& b) {
    return b.film.energy - a.film.energy <= kSameFilm * std::abs(a.film.energy);
  };
  films.erase(std::unique(films.begin(), films.end(), same), films.end());
  if (films.size() > most) {
    films.resize(most);
  }
}

std::vector<Candidate> children_of(const Candidate& parent,
                                   const PopSearchOptions& options) {
  std::vector<Candidate> result;
  for (const double collapsed : kCollapsed) {
    for (const bool flipped : {false, true}) {
      Candidate child = parent;
      films::FilmComplex& complex = child.film.complex;
      if (collapsed > 0.0) {
        groom::collapse_tiny_edges(complex, collapsed * parent.mean_edge);
      }
      if (flipped) {
        groom::equiangulate(complex);
      }
      try {
        advance(child, options);
        result.push_back(std::move(child));
      } catch (const InvalidInput&) {
        // This history ends where no film can move.
      }
    }
  }
  return result;
}

std::size_t width_of(const std::vector<Candidate>& films,
                     const PopSearchOptions& options) {
  const double facets =
      static_cast<double>(films.front().film.complex.mesh.facets.size());
  const double affordable =
      options.most_work / (facets * options.most_rounds * 6.0);
  return static_cast<std::size_t>(
      std::clamp(affordable, 1.0, static_cast<double>(options.width)));
}

}  // namespace

std::vector<PoppedFilm> search_pops(
    const std::vector<films::FilmComplex>& starts,
    const PopSearchOptions& options) {
  // Every start popped and relaxed once.
  std::vector<Candidate> films;
  for (const films::FilmComplex& start : starts) {
    Candidate candidate{.film = {.complex = start},
                        .mean_edge = mean_edge_of(start)};
    advance(candidate, options);
    films.push_back(std::move(candidate));
  }
  std::vector<Candidate> found;
  int idle = 0;
  for (int round = 0;
       round < options.most_rounds && !films.empty() && idle < options.patience;
       ++round) {
    // A beam search: all children of the films kept, of which the lowest in
    // energy go on.
    const std::size_t width = width_of(films, options);
    std::vector<Candidate> next;
    for (const Candidate& film : films) {
      for (Candidate& child : children_of(film, options)) {
        next.push_back(std::move(child));
      }
    }
    keep_lowest(next, width);
    films = std::move(next);
    // Films with nothing left to pop are results; the rounds end when none
    // lower comes for a while.
    const bool first = found.empty();
    const double before = first ? 0.0 : found[0].film.energy;
    for (const Candidate& film : films) {
      films::FilmComplex copy = film.film.complex;
      if (pop_all(copy) == 0) {
        found.push_back(film);
      }
    }
    keep_lowest(found, static_cast<std::size_t>(options.most_found));
    const bool lower =
        !found.empty() &&
        (first || found[0].film.energy < before - kSameFilm * std::abs(before));
    idle = lower || found.empty() ? 0 : idle + 1;
  }
  std::vector<PoppedFilm> result;
  result.reserve(found.size());
  for (Candidate& candidate : found) {
    result.push_back(std::move(candidate.film));
  }
  return result;
}

}  // namespace meniscus::settle
