#include "pipeline/results/datafile.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/heed_stop.h"
#include "core/math/expression.h"
#include "core/memory.h"
#include "core/timer.h"
#include "evolve/datafile/fe_bodies.h"
#include "evolve/datafile/fe_script.h"
#include "evolve/datafile/fe_write.h"
#include "evolve/groom/flip_average.h"
#include "evolve/groom/pop.h"
#include "evolve/groom/refine.h"
#include "evolve/settle/equilibrium.h"
#include "evolve/settle/find_equilibrium.h"
#include "evolve/settle/pop_search.h"
#include "evolve/settle/slide_vertices.h"
#include "io/vtk_files.h"
#include "pipeline/results/evolved_film.h"
#include "pipeline/results/results.h"

namespace meniscus::results {

namespace {

constexpr double kEnoughFacets = 2000.0;
constexpr long kEvaluationsPerStep = 30;   // on average; a dozen are usual
constexpr double kDescentResidual = 1e-6;  // x tension x edge
constexpr double kMostFacets = 8e6;        // as a script's own
constexpr double kBytesPerFacet = 1000.0;  // of a film that settles
// Facets below which vertices slide: there what facets miss is more than a
// rounding, and the shapes that sliding leaves do not matter.
constexpr std::size_t kSlid = 2000;

int refinements_of(const films::FilmComplex& complex,
                   const DatafileOptions& options) {
  if (options.refinements) {
    return *options.refinements;
  }
  auto facets = static_cast<double>(std::count_if(
      complex.mesh.facet_label.begin(), complex.mesh.facet_label.end(),
      [&](int s) { return complex.surfaces[s].liquid; }));
  int result = 0;
  for (; facets > 0.0 && facets < kEnoughFacets; facets *= 4.0) {
    ++result;
  }
  return result;
}

double residual_bound_of(const energy::FilmEnergy& energy, const Points& points,
                         const films::FilmTargets& targets) {
  return kDescentResidual * films::largest_tension(targets) *
         energy.mean_edge(points);
}

/// Throws InvalidInput where so many refinements make more facets than the
/// machine has room for.
void require_room(const films::FilmComplex& complex, int refinements) {
  const double facets = static_cast<double>(complex.mesh.facets.size()) *
                        std::pow(4.0, refinements);
  const double room = available_memory();
  if (facets > kMostFacets || kBytesPerFacet * facets > room) {
    throw InvalidInput(fmt::format(
        "{} refinements make {:.2g} facets, which need {:.2g} GB; at most "
        "{:.2g} facets and the {:.2g} GB that are free can be settled: refine "
        "less",
        refinements, facets, kBytesPerFacet * facets / 1e9, kMostFacets,
        room / 1e9));
  }
}

/// The film as descent left it, with the verdict; of one that was stopped
/// nothing is computed any more.
settle::FilmState state_after(const films::FilmComplex& complex,
                              const settle::DescentReport& descent, int steps,
                              bool stopped) {
  const energy::FilmEnergy energy(complex);
  const films::FilmTargets targets = energy::targets_of(complex);
  settle::FilmState state;
  state.points = complex.mesh.points;
  settle::FilmReport& figures = state.report;
  figures = settle::figures_of(energy, targets, state.points, descent.pressure);
  figures.residual = descent.residual;
  figures.residual_bound = residual_bound_of(energy, state.points, targets);
  figures.iterations = steps;
  if (stopped) {
    figures.verdict = descent.message;
    figures.min_eigenvalue = std::numeric_limits<double>::quiet_NaN();
    return state;
  }
  const energy::LowestMode mode =
      settle::lowest_mode_of(energy, targets, state.points, descent.pressure);
  figures.min_eigenvalue = mode.eigenvalue;
  figures.index = mode.eigenvalue < 0.0 ? 1 : 0;
  figures.index_at_least = figures.index > 0;
  const bool at_rest = figures.residual <= figures.residual_bound;
  settle::set_verdict(energy, complex,
                      {.reason = at_rest ? "" : descent.message}, state);
  return state;
}

settle::DescentReport descend_to_rest(films::FilmComplex& complex,
                                      settle::DescentOptions options) {
  const energy::FilmEnergy energy(complex);
  const films::FilmTargets targets = energy::targets_of(complex);
  const Points directions = energy.space().directions(complex.mesh.points);
  options.residual_bound =
      residual_bound_of(energy, complex.mesh.points, targets);
  return settle::descend(energy, targets, directions, complex.mesh.points,
                         options);
}

/// The paper's motion, refined and groomed between its runs.
settle::FilmState descend_by_levels(films::FilmComplex& complex,
                                    int refinements,
                                    const DatafileOptions& options,
                                    bool& stopped) {
  const settle::DescentMethod method =
      options.method == DatafileMethod::Gradient
          ? settle::DescentMethod::Gradient
          : settle::DescentMethod::ConjugateGradients;
  settle::DescentReport report;
  films::FilmComplex before;  // of grooming, which leaves nothing when stopped
  std::optional<Heeding> deaf;  // to the stop that was heard
  int steps = 0;
  try {
    for (int level = 0; level <= refinements; ++level) {
      if (level > 0) {
        complex = groom::refine(complex).complex;
      }
      before = complex;
      groom::equiangulate(complex);
      groom::average_vertices(complex);
      report = descend_to_rest(
          complex, {.method = method,
                    .max_steps = options.max_steps,
                    .max_evaluations = kEvaluationsPerStep * options.max_steps,
                    .monitor = options.monitor});
      steps += report.steps;
    }
  } catch (const Interrupted&) {  // what there is of it is kept
    stopped = true;
    deaf.emplace(&silent_monitor());
    if (complex.mesh.facets.empty()) {
      complex = std::move(before);
    }
    report = descend_to_rest(complex, {.max_steps = 0, .most_restore = 0.0});
    report.message = "stopped on request";
  }
  settle::require_motion(complex);
  return state_after(complex, report, steps, stopped);
}

/// The film as it is, with the verdict on it.
settle::FilmState judge_macro(films::FilmComplex& complex, int iterations) {
  settle::DescentReport now =
      descend_to_rest(complex, {.max_steps = 0, .most_restore = 0.0});
  now.message = "the macro ended here";
  settle::FilmState state = state_after(complex, now, iterations, false);
  if (state.report.residual > state.report.residual_bound) {
    state.report.verdict = fmt::format(
        "not at rest: the macro ended at a residual of {:.3g} (bound {:.3g})",
        state.report.residual, state.report.residual_bound);
  }
  if (energy::FilmSpace(complex).unknowns() == 0) {
    state.report.verdict = "as the file has it: nothing in it moves";
  }
  state.failure.reset();
  return state;
}

/// Our own route: raw facets flipped as Surface Evolver's users do with `u`,
/// equilibrium, and where facets are few, vertices moved to where they have
/// least area, as `g` does.
settle::FilmState settle(films::FilmComplex& complex,
                         const settle::FindOptions& options) {
  groom::equiangulate(complex, groom::FlipRule::AnglesOnly);
  settle::FilmState state = settle::find_equilibrium(complex, options);
  if (state.failure || complex.mesh.facets.size() >= kSlid) {
    return state;
  }
  films::FilmComplex slid = complex;
  settle::FilmState lower =
      settle::slide_vertices(slid, {.settle = options.settle});
  if (lower.failure || !(lower.report.energy < state.report.energy)) {
    return state;
  }
  lower.report.iterations += state.report.iterations;
  complex = std::move(slid);
  return lower;
}

/// Settled; where junctions are to pop or there is no stable film, the
/// histories of pops are searched from the start and from the start at rest,
/// and the lowest films that they end at are settled in turn.
settle::FilmState settle_and_pop(films::FilmComplex& complex,
                                 const settle::FindOptions& options,
                                 int& popped) {
  films::FilmComplex raw = complex;
  settle::FilmState state = settle(complex, options);
  films::FilmComplex rested = raw;
  groom::equiangulate(rested, groom::FlipRule::AnglesOnly);
  settle::find_equilibrium(rested, {.settle = options.settle});
  films::FilmComplex probe = rested;
  if (!state.failure &&
      groom::pop_edges(probe).popped + groom::pop_vertices(probe).popped == 0) {
    return state;
  }
  std::optional<settle::FilmState> lowest;
  for (settle::PoppedFilm& film : settle::search_pops(
           {raw, rested}, {.monitor = options.settle.monitor})) {
    settle::FilmState found = settle(film.complex, options);
    if (!found.failure &&
        (!lowest || found.report.energy < lowest->report.energy)) {
      lowest = std::move(found);
      complex = std::move(film.complex);
      popped = film.popped;
    }
  }
  return lowest ? std::move(*lowest) : std::move(state);
}

films::NestingReport nesting_of_films(const films::FilmComplex& complex) {
  std::vector<int> liquid;
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    if (complex.surfaces[s].liquid) {
      liquid.push_back(static_cast<int>(s));
    }
  }
  return liquid.empty() ? films::NestingReport{}
                        : films::check_nesting(complex.mesh, liquid);
}

DatafileResult evolve_film(const datafile::FeFile& file,
                           const DatafileOptions& options) {
  const Heeding heeding(options.monitor);
  const Timer timer;
  // Commands of the file that stand outside its macros are part of the film.
  datafile::FeScriptResult script = datafile::run_fe_script(
      file, options.parameters,
      {.macro = options.macro, .monitor = options.monitor});
  DatafileResult result;
  result.complex = std::move(script.complex);
  result.printed = std::move(script.output);
  const int refinements = refinements_of(result.complex, options);
  require_room(result.complex, refinements);
  settle::FilmState state;
  if (options.macro) {
    state = judge_macro(result.complex, script.iterations);
  } else if (options.method == DatafileMethod::Newton) {
    const settle::FindOptions find{.refinements = refinements,
                                   .settle = {.monitor = options.monitor}};
    state = options.pop ? settle_and_pop(result.complex, find, result.popped)
                        : settle(result.complex, find);
  } else {
    state =
        descend_by_levels(result.complex, refinements, options, result.stopped);
  }
  const energy::FilmEnergy energy(result.complex);
  const VectorX values = energy.quantities(result.complex.mesh.points,
                                           energy::targets_of(result.complex));
  for (std::size_t q = 0; q < result.complex.quantities.size(); ++q) {
    result.quantities.emplace_back(result.complex.quantities[q].name,
                                   values[static_cast<Eigen::Index>(q)]);
  }
  result.report = std::move(state.report);
  result.report.seconds = timer.seconds();
  result.failure = std::move(state.failure);
  if (!result.failure) {
    result.nesting = nesting_of_films(result.complex);
  }
  return result;
}

}  // namespace

DatafileResult evolve_datafile(const std::filesystem::path& path,
                               const DatafileOptions& options) {
  const datafile::FeFile file =
      datafile::read_fe(read_file(path), path.filename().string());
  datafile::check_fe_bodies(file);
  try {
    return evolve_film(file, options);
  } catch (const ExpressionError& error) {
    throw InvalidInput(
        fmt::format("{}: a formula has no value where the film went: {}",
                    file.name, error.what()));
  }
}

std::vector<std::string> solids_of(const films::FilmComplex& complex) {
  std::vector<std::string> solids;
  for (const films::ComplexSurface& surface : complex.surfaces) {
    if (!surface.liquid) {
      solids.push_back(surface.name);
    }
  }
  return solids;
}

std::string write_datafile_result(const DatafileResult& result,
                                  const std::string& title,
                                  const std::filesystem::path& folder) {
  io::write_vtp(folder / "film.vtp", result.complex.mesh);
  EvolvedFilm film{.title = title,
                   .report = result.report,
                   .nesting = result.nesting,
                   .failure = result.failure,
                   .solids = solids_of(result.complex),
                   .curves = pieces_of_curves(result.complex),
                   .quantities = result.quantities};
  write_evolved_film(film, {}, folder);
  try {
    write_file(folder / "film.fe", datafile::fe_text(result.complex));
  } catch (const InvalidInput& error) {
    return fmt::format("film.fe is left out: {}", error.what());
  }
  return "";
}

std::string datafile_text(const DatafileResult& result) {
  const settle::FilmReport& film = result.report;
  std::string text = result.printed;
  text += fmt::format(
      "film: {}\n  {} vertices, {} facets, area {:.12g}, energy {:.12g} (units "
      "of the datafile)\n  residual {:.2e} (bound {:.2e}), smallest eigenvalue "
      "{:.4g}, index {}\n",
      film.verdict, film.vertices, film.facets, film.area, film.energy,
      film.residual, film.residual_bound, film.min_eigenvalue,
      settle::index_text(film));
  if (film.smallest_neck > 0.0) {
    text += fmt::format("  smallest neck {:.4g} at ({:.4g}, {:.4g}, {:.4g})\n",
                        film.smallest_neck, film.neck_position.x(),
                        film.neck_position.y(), film.neck_position.z());
  }
  if (const std::string nesting = films::nesting_text(result.nesting);
      !nesting.empty()) {
    text += fmt::format("  films {}\n", nesting);
  }
  for (const settle::BodyState& body : film.bodies) {
    text += fmt::format("  {}: volume {:.12g}, pressure {:.8g}\n", body.name,
                        body.volume, body.pressure);
  }
  for (const auto& [name, value] : result.quantities) {
    text += fmt::format("  quantity {}: {:.12g}\n", name, value);
  }
  if (result.popped > 0) {
    text += fmt::format("  {} junctions popped\n", result.popped);
  }
  text +=
      fmt::format("  {} steps in {:.2f} s\n", film.iterations, film.seconds);
  return text;
}

}  // namespace meniscus::results
