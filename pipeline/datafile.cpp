#include "pipeline/datafile.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/timer.h"
#include "evolve/equilibrium.h"
#include "evolve/fe_write.h"
#include "evolve/find_equilibrium.h"
#include "evolve/grooming.h"
#include "io/atomic_file.h"
#include "io/vtk_files.h"
#include "pipeline/results.h"

namespace meniscus {

namespace {

constexpr double kEnoughFacets = 2000.0;
constexpr double kDescentResidual = 1e-6;  // x tension x edge

int refinements_of(const FilmComplex& complex, const DatafileOptions& options) {
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

double largest_tension(const FilmTargets& targets) {
  return targets.tension.empty() ? 0.0
                                 : *std::max_element(targets.tension.begin(),
                                                     targets.tension.end());
}

/// The paper's motion, refined and groomed between its runs.
FilmState descend_by_levels(FilmComplex& complex, int refinements,
                            const DatafileOptions& options) {
  DescentReport report;
  int steps = 0;
  for (int level = 0; level <= refinements; ++level) {
    if (level > 0) {
      complex = refine(complex).complex;
    }
    equiangulate(complex);
    average_vertices(complex);
    const FilmEnergy energy(complex);
    const FilmTargets targets = targets_of(complex);
    const double bound = kDescentResidual * largest_tension(targets) *
                         energy.mean_edge(complex.mesh.points);
    report =
        descend(energy, targets, energy.space().directions(complex.mesh.points),
                complex.mesh.points,
                {.method = options.method == DatafileMethod::Gradient
                               ? DescentMethod::Gradient
                               : DescentMethod::ConjugateGradients,
                 .max_steps = options.max_steps,
                 .residual_bound = bound,
                 .monitor = options.monitor});
    steps += report.steps;
  }
  const FilmEnergy energy(complex);
  const FilmTargets targets = targets_of(complex);
  FilmState state;
  state.points = complex.mesh.points;
  FilmReport& figures = state.report;
  figures.vertices = static_cast<int>(state.points.size());
  figures.facets = static_cast<int>(complex.mesh.facets.size());
  figures.energy = energy.value(state.points, targets);
  figures.area = energy.area(state.points);
  figures.residual = report.residual;
  figures.residual_bound = kDescentResidual * largest_tension(targets) *
                           energy.mean_edge(state.points);
  figures.iterations = steps;
  const VectorX volumes = energy.volumes(state.points);
  for (int b = 0; b < energy.functionals(); ++b) {
    figures.bodies.push_back({targets.bodies[b].name, volumes[b],
                              targets.bodies[b].volume.value_or(volumes[b]),
                              report.pressure[b]});
  }
  const LowestMode mode =
      lowest_mode_of(energy, targets, state.points, report.pressure);
  figures.min_eigenvalue = mode.eigenvalue;
  figures.index = mode.eigenvalue < 0.0 ? 1 : 0;
  judge(energy, complex, {.reason = report.converged ? "" : report.message},
        state);
  return state;
}

}  // namespace

DatafileResult evolve_datafile(const std::filesystem::path& path,
                               const DatafileOptions& options) {
  const Timer timer;
  const FeFile file = read_fe(read_file(path), path.filename().string());
  DatafileResult result;
  result.complex = complex_of(file, options.parameters);
  const int refinements = refinements_of(result.complex, options);
  FilmState state;
  if (options.method == DatafileMethod::Newton) {
    state = find_equilibrium(
        result.complex,
        {.refinements = refinements, .settle = {.monitor = options.monitor}});
  } else {
    state = descend_by_levels(result.complex, refinements, options);
  }
  const FilmEnergy energy(result.complex);
  const VectorX values = energy.quantities(result.complex.mesh.points);
  for (std::size_t q = 0; q < result.complex.quantities.size(); ++q) {
    result.quantities.emplace_back(result.complex.quantities[q].name,
                                   values[static_cast<Eigen::Index>(q)]);
  }
  result.report = std::move(state.report);
  result.report.seconds = timer.seconds();
  result.failure = std::move(state.failure);
  return result;
}

std::string write_datafile_result(const DatafileResult& result,
                                  const std::filesystem::path& folder) {
  write_vtp(folder / "film.vtp", result.complex.mesh);
  nlohmann::ordered_json json = film_json(result.report);
  for (const auto& [name, value] : result.quantities) {
    json["quantities"][name] = value;
  }
  json["seconds"] = result.report.seconds;
  write_file(folder / "film.json", json.dump(2) + "\n");
  try {
    write_file(folder / "film.fe", fe_text(result.complex));
  } catch (const InvalidInput& error) {
    return fmt::format("film.fe is left out: {}", error.what());
  }
  return "";
}

std::string datafile_text(const DatafileResult& result) {
  const FilmReport& film = result.report;
  std::string text = fmt::format(
      "film: {}\n  {} vertices, {} facets, area {:.12g}, energy {:.12g} (units "
      "of the datafile)\n  residual {:.2e} (bound {:.2e}), smallest eigenvalue "
      "{:.4g}, index {}\n",
      film.verdict, film.vertices, film.facets, film.area, film.energy,
      film.residual, film.residual_bound, film.min_eigenvalue, film.index);
  if (film.smallest_neck > 0.0) {
    text += fmt::format("  smallest neck {:.4g} at ({:.4g}, {:.4g}, {:.4g})\n",
                        film.smallest_neck, film.neck_position.x(),
                        film.neck_position.y(), film.neck_position.z());
  }
  for (const BodyState& body : film.bodies) {
    text += fmt::format("  {}: volume {:.12g}, pressure {:.8g}\n", body.name,
                        body.volume, body.pressure);
  }
  for (const auto& [name, value] : result.quantities) {
    text += fmt::format("  quantity {}: {:.12g}\n", name, value);
  }
  text +=
      fmt::format("  {} steps in {:.2f} s\n", film.iterations, film.seconds);
  return text;
}

}  // namespace meniscus
