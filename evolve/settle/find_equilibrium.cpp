#include "evolve/settle/find_equilibrium.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/expression.h"
#include "core/timer.h"
#include "evolve/films/nesting.h"
#include "evolve/films/rim_grading.h"
#include "evolve/groom/bend_midpoints.h"
#include "evolve/groom/flip_average.h"
#include "evolve/groom/junctions.h"
#include "evolve/groom/refine.h"
#include "evolve/groom/remesh.h"
#include "evolve/groom/rough_films.h"
#include "evolve/settle/bring_near.h"
#include "evolve/settle/bring_near_gently.h"
#include "evolve/settle/contacts.h"
#include "evolve/settle/neck.h"
#include "evolve/settle/nested_newton.h"

namespace meniscus::settle {

namespace {

// Where Newton finds no film, flow goes on so long, to tell a film that tears
// from one that rests.
constexpr int kLongRounds = 30;
constexpr double kLongChange = 1e-8;
constexpr double kLongMotion = 0.25;  // x edge, per step
constexpr int kMendRounds = 4;        // of new facets where Newton stops
constexpr int kPolishRounds = 2;      // of averaging and Newton at the end
// Facets up to which a film is groomed, and factored directly, before nested
// refinement goes on.
constexpr std::size_t kGroomed = 1500;
constexpr std::size_t kDirect = 6000;
constexpr int kContactRounds = 40;
constexpr double kCoarseNeck = 3.0;       // x mean edge of the coarse level
constexpr double kLooseReduction = 1e-2;  // on levels that are refined further

FilmState given_up(const films::FilmComplex& complex, const std::string& reason,
                   int steps) {
  const energy::FilmEnergy energy(complex);
  FilmState state;
  state.points = complex.mesh.points;
  state.heights = VectorX::Zero(energy.unknowns());
  const films::FilmTargets targets = energy::targets_of(complex);
  VectorX pressure(energy.functionals());
  for (int b = 0; b < energy.functionals(); ++b) {
    pressure[b] = targets.bodies[b].pressure.value_or(0.0);
  }
  state.report = figures_of(energy, targets, state.points, pressure);
  state.report.iterations = steps;
  VerdictInput input{.reason = reason};
  if (reason == kFilmGrows) {
    input.neck = Neck{};  // whatever comes near is no neck
  }
  set_verdict(energy, complex, input, state);
  return state;
}

void remesh(films::FilmComplex& complex, double edge) {
  groom::remesh_films(
      complex, {.edge = edge, .edge_field = films::graded_edge(complex, edge)});
}

/// Coarse to fine over the edges edge x 2^k, k = levels..0. Empty when the
/// film came near rest; else why not.
std::string bring_near_by_levels(films::FilmComplex& complex,
                                 const FindOptions& options, int levels,
                                 int& steps) {
  for (int level = levels; level >= 0; --level) {
    const double edge = *options.edge * std::exp2(level);
    if (level < levels) {
      complex = groom::refine(complex).complex;
    }
    remesh(complex, edge);
    std::string reason = bring_near(complex, edge, options.max_rounds, steps,
                                    {.monitor = options.settle.monitor});
    if (!reason.empty()) {
      return reason;
    }
  }
  return "";
}

/// Settled, though its neck may need shorter edges.
bool is_settled(const FilmState& state) {
  return !state.failure ||
         (state.failure->kind == FailureKind::FilmPinched &&
          state.report.index == 0 &&
          state.report.residual <= state.report.residual_bound &&
          state.report.residual_bound > 0.0);
}

/// Newton, and again with other contacts while one-sided walls ask for it.
FilmState settle_with_contacts(films::FilmComplex& complex, double usual_neck,
                               const SettleOptions& options, int& steps) {
  for (int round = 0;; ++round) {
    const energy::FilmEnergy energy(complex);
    FilmState state =
        settle_past_saddles(energy, complex, energy::targets_of(complex),
                            complex.mesh.points, options, usual_neck);
    steps += state.report.iterations;
    complex.mesh.points = state.points;
    if (!has_contacts(complex) || round == kContactRounds) {
      return state;
    }
    if (update_contacts(complex, energy, pressures_of(state.report)) == 0) {
      return state;
    }
  }
}

/// The same; where it finds no film, flow tells whether one is there.
FilmState settle_or_follow(films::FilmComplex& complex, double usual_neck,
                           const SettleOptions& options, int& steps) {
  const Points before = complex.mesh.points;
  FilmState state = settle_with_contacts(complex, usual_neck, options, steps);
  if (!state.failure || state.failure->kind != FailureKind::FilmNotFound ||
      complex.mesh.facets.size() > kDirect) {
    return state;
  }
  complex.mesh.points = before;
  const std::string reason =
      bring_near(complex, {}, kLongRounds, steps,
                 {.energy_change = kLongChange,
                  .most_motion = kLongMotion * mean_edge_length(complex.mesh),
                  .monitor = options.monitor});
  return reason.empty()
             ? settle_with_contacts(complex, usual_neck, options, steps)
             : given_up(complex, reason, steps);
}

/// Newton, and vertex averaging so that facets are good where the film is.
FilmState settle_and_polish(films::FilmComplex& complex,
                            const FindOptions& options, int& steps) {
  require_motion(complex);
  FilmState state;
  int mended = 0;
  for (int round = 0; round <= kPolishRounds; ++round) {
    if (round > 0) {
      groom::equiangulate(complex);
      groom::average_vertices(complex);
    }
    state = settle_or_follow(complex, 0.0, options.settle, steps);
    // Facets that fold before the film rests: new ones where it stands.
    for (; options.edge && mended < kMendRounds && !is_settled(state) &&
           state.failure->kind != FailureKind::FilmUnstable;
         ++mended) {
      remesh(complex, *options.edge);
      if (!bring_near(complex, options.edge, 1, steps,
                      {.monitor = options.settle.monitor})
               .empty()) {
        break;
      }
      state = settle_or_follow(complex, 0.0, options.settle, steps);
    }
    if (!is_settled(state) || (!options.edge && options.refinements == 0)) {
      break;
    }
  }
  return state;
}

/// The chain of nested levels; the coarsest was groomed and settled.
struct Chain {
  std::vector<std::unique_ptr<energy::FilmEnergy>> energies;
  std::vector<FilmLevel> levels;
  Neck neck;  // of the finest level that was measured

  void add(const films::FilmComplex& complex, std::vector<Edge> parents) {
    energies.push_back(std::make_unique<energy::FilmEnergy>(complex));
    if (!levels.empty() &&
        !is_nested(*levels.back().energy, *energies.back(), parents)) {
      // Parts that stay unrefined break the chain: start anew from here.
      levels.clear();
      parents.clear();
    }
    levels.push_back({energies.back().get(), std::move(parents)});
  }

  void measure_neck(const films::FilmComplex& complex) {
    neck = narrowest_neck(*energies.back(), complex.mesh.points,
                          complex.mesh.facet_label);
  }
};

/// One level finer. `last`: to the stop criterion, with the verdict.
FilmState settle_finer(Chain& chain, films::FilmComplex& complex,
                       FilmState state, const FindOptions& options, bool last,
                       int& steps) {
  const energy::FilmEnergy& coarse = *chain.energies.back();
  groom::Refinement finer = groom::refine(complex);
  groom::bend_midpoints(coarse.space(), complex.mesh.points, finer);
  complex = std::move(finer.complex);
  if (complex.mesh.facets.size() <= kDirect &&
      groom::even_out(complex, groom::EvenOut::Flips)) {
    chain = Chain();  // the coarse levels have other facets
    finer.parents.clear();
  }
  chain.add(complex, std::move(finer.parents));
  const energy::FilmEnergy& energy = *chain.energies.back();
  const films::FilmTargets targets = energy::targets_of(complex);
  const bool direct =
      complex.mesh.facets.size() <= kDirect || chain.levels.size() < 2;
  const auto settle_directly = [&] {
    const auto settle_now = [&] {
      return settle_or_follow(complex, state.report.smallest_neck,
                              options.settle, steps);
    };
    FilmState found = settle_now();
    // Facets that were even where the film began may be folded where it ends.
    for (int round = 0; round < kPolishRounds && is_settled(found) &&
                        complex.mesh.facets.size() <= kDirect &&
                        groom::even_out(complex, groom::EvenOut::Flips);
         ++round) {
      chain = Chain();
      chain.add(complex, {});
      found = settle_now();
    }
    if (has_contacts(complex)) {
      chain = Chain();  // ranks may have changed
      chain.add(complex, {});
    }
    chain.measure_neck(complex);
    return found;
  };
  if (direct || has_contacts(complex)) {
    return settle_directly();
  }
  const double tension = films::largest_tension(targets);
  NestedNewton newton(chain.levels, targets);
  NestedOptions nested{.residual_bound = options.settle.residual_factor *
                                         tension *
                                         energy.mean_edge(complex.mesh.points),
                       .volume_tolerance = options.settle.volume_tolerance,
                       .reduction = last ? 0.0 : kLooseReduction,
                       .monitor = options.settle.monitor};
  NestedResult found =
      newton.run(complex.mesh.points, pressures_of(state.report), nested);
  steps += found.iterations;
  // Around corners, where a film turns far, refined facets fold.
  if (!found.converged && groom::even_out(complex, groom::EvenOut::KeepEdges)) {
    found = newton.run(complex.mesh.points, pressures_of(state.report), nested);
    steps += found.iterations;
  }
  if (!found.converged) {
    return settle_directly();
  }
  complex.mesh.points = found.points;
  const FilmReport before = std::move(state.report);
  state.report = figures_of(energy, targets, found.points, found.pressure);
  state.report.residual = found.residual;
  state.report.residual_bound = nested.residual_bound;
  if (!last) {
    state.report.smallest_neck = before.smallest_neck;
    state.report.neck_position = before.neck_position;
    state.report.index = before.index;
    state.failure.reset();  // a thin neck is judged at the end
    return state;
  }
  const energy::LowestMode guess =
      lowest_mode_of(*chain.levels.front().energy, targets, complex.mesh.points,
                     found.pressure);
  const NestedModes modes = newton.lowest_modes(guess.mode);
  state.report.min_eigenvalue = modes.eigenvalues[0];
  state.report.index = modes.eigenvalues[0] < 0.0 ? 1 : 0;
  state.report.index_at_least = state.report.index > 0;
  state.points = found.points;
  state.heights = VectorX::Zero(energy.unknowns());
  VerdictInput input;
  input.mode_position = modes.position;
  // Rays from every fine vertex take half as long as settling does: only where
  // few coarse edges cross the neck do the fine facets decide. Else its width
  // would have to fall to a third between the levels to be too thin.
  const double near =
      kCoarseNeck * chain.levels.front().energy->mean_edge(complex.mesh.points);
  if (chain.neck.surface >= 0 && chain.neck.width < near) {
    chain.measure_neck(complex);
  }
  input.neck = chain.neck;
  set_verdict(energy, complex, input, state);
  return state;
}

/// Flow on the start and its refinements until the film is near rest at
/// kGroomed facets, each level groomed; `blind` of them without flow, for films
/// that the coarse levels tear. What stays undone is left in `left`.
std::string bring_near_nested(films::FilmComplex& complex,
                              const FindOptions& options, int blind, int& left,
                              int& steps) {
  const auto flow = [&] {
    return bring_near(complex, {}, options.max_rounds, steps,
                      {.monitor = options.settle.monitor});
  };
  std::string reason = blind > 0 ? "" : flow();
  while (reason.empty() && left > 0 &&
         4 * complex.mesh.facets.size() <= kGroomed) {
    complex = groom::refine(complex).complex;
    --left;
    if (--blind <= 0) {
      groom::equiangulate(complex);
      groom::average_vertices(complex);
      reason = flow();
    }
  }
  return reason;
}

/// A film with a junction that no film keeps is no minimum, however well it
/// settled.
void check_junctions(const std::optional<groom::UnstableJunction>& junction,
                     FilmState& state) {
  if (!junction || state.failure) {
    return;
  }
  const Vec3& at = junction->place;
  state.report.verdict =
      fmt::format("unstable: {} at ({:.4g}, {:.4g}, {:.4g}); {}",
                  junction->line ? "more than three films meet along the line"
                                 : "films meet otherwise than in four lines",
                  at.x(), at.y(), at.z(), kPopHelps);
  state.failure = Failure{FailureKind::FilmUnstable, state.report.verdict};
}

/// The refinements that are `left`, each from the settled film before it.
FilmState settle_nested(films::FilmComplex& complex, FilmState state, int left,
                        const FindOptions& options, int& steps) {
  // Refinement keeps junctions: looked for while they are few.
  const auto junction = groom::unstable_junction(complex);
  // Nested iteration: each finer level starts from the settled one, with the
  // chain as its multigrid.
  Chain chain;
  if (left > 0) {
    chain.add(complex, {});
    chain.measure_neck(complex);
  }
  for (; left > 0 && is_settled(state); --left) {
    state = settle_finer(chain, complex, std::move(state), options, left == 1,
                         steps);
  }
  check_junctions(junction, state);
  return state;
}

bool crosses_itself(const films::FilmComplex& complex) {
  std::vector<int> liquid;
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    if (complex.surfaces[s].liquid) {
      liquid.push_back(static_cast<int>(s));
    }
  }
  return films::check_nesting(complex.mesh, liquid).crossing_pairs > 0;
}

/// Is it worth a second try? Not where the film was found to grow or to be a
/// saddle, nor where that takes long; few facets rest where there is no film.
bool may_try_again(const films::FilmComplex& raw, const FindOptions& options,
                   const FilmState& state, bool grows) {
  const std::size_t facets = raw.mesh.facets.size();
  return !is_settled(state) && !grows &&
         state.failure->kind != FailureKind::FilmUnstable &&
         facets <= kDirect && facets << (2 * options.refinements) >= kGroomed;
}

/// Once more from the raw start, where the usual way found no film; none where
/// this way finds none either, or one that crosses itself.
std::optional<FilmState> find_gently(films::FilmComplex& complex,
                                     const FindOptions& options, int& steps) {
  std::optional<FilmState> found;
  const auto find = [&] {
    const int left = bring_near_gently(complex,
                                       {.refinements = options.refinements,
                                        .most_facets = kGroomed,
                                        .monitor = options.settle.monitor},
                                       steps);
    FilmState state = settle_with_contacts(complex, 0.0, options.settle, steps);
    if (is_settled(state)) {
      state = settle_and_polish(complex, options, steps);
      state = settle_nested(complex, std::move(state), left, options, steps);
    }
    if (!state.failure && !crosses_itself(complex)) {
      found = std::move(state);
    }
  };
  try {
    what_prevents(find);
  } catch (const ExpressionError&) {
    // where a formula has no value there is no film
  }
  return found;
}

/// Nested refinements of a start: groomed and settled while it is coarse.
FilmState find_nested(films::FilmComplex& complex, const FindOptions& options,
                      int& steps) {
  const films::FilmComplex raw = complex;
  FilmState state;
  int left = 0;
  bool grows = false;
  // Coarse facets may tear a film that exists: retry with the first flow one
  // refinement later each time, while that is affordable.
  for (const int blind : {0, 1, 2, 3}) {
    if (blind > options.refinements ||
        (blind > 1 && raw.mesh.facets.size() << (2 * blind) > kGroomed)) {
      break;
    }
    films::FilmComplex attempt = raw;
    int rest = options.refinements;
    const std::string reason =
        bring_near_nested(attempt, options, blind, rest, steps);
    FilmState found = reason.empty()
                          ? settle_and_polish(attempt, options, steps)
                          : given_up(attempt, reason, steps);
    grows = grows || reason == kFilmGrows;
    if (blind == 0 || is_settled(found)) {
      state = std::move(found);
      complex = std::move(attempt);
      left = rest;
    }
    if (is_settled(state) || state.failure->kind == FailureKind::FilmUnstable) {
      break;
    }
  }
  state = settle_nested(complex, std::move(state), left, options, steps);
  if (!may_try_again(raw, options, state, grows)) {
    return state;
  }
  films::FilmComplex again = raw;
  if (std::optional<FilmState> found = find_gently(again, options, steps)) {
    complex = std::move(again);
    return *std::move(found);
  }
  return state;
}

}  // namespace

void require_motion(const films::FilmComplex& complex) {
  if (energy::FilmSpace(complex).unknowns() == 0) {
    throw InvalidInput(fmt::format(
        "the film has no vertex between its curves at a mean edge of {:.4g}; "
        "use a shorter edge",
        mean_edge_length(complex.mesh)));
  }
}

FilmState find_equilibrium(films::FilmComplex& complex,
                           const FindOptions& options) {
  const Timer timer;
  int steps = 0;
  if (!options.edge) {
    FilmState state = find_nested(complex, options, steps);
    state.report.iterations = steps;
    state.report.seconds = timer.seconds();
    return state;
  }
  const int levels = options.halvings;
  films::FilmComplex raw = complex;
  std::string reason = bring_near_by_levels(complex, options, levels, steps);
  if (!reason.empty() && levels > 0) {
    // A coarse film pinches earlier: the same without the coarse levels.
    for (int level = 0; level < levels; ++level) {
      raw = groom::refine(raw).complex;
    }
    complex = std::move(raw);
    reason = bring_near_by_levels(complex, options, 0, steps);
  }
  FilmState state = reason.empty() ? settle_and_polish(complex, options, steps)
                                   : given_up(complex, reason, steps);
  check_junctions(groom::unstable_junction(complex), state);
  state.report.iterations = steps;
  state.report.seconds = timer.seconds();
  return state;
}

}  // namespace meniscus::settle
