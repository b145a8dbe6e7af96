#include "evolve/find_equilibrium.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/timer.h"
#include "evolve/curvature_flow.h"
#include "evolve/grooming.h"
#include "evolve/neck.h"

namespace meniscus {

namespace {

constexpr int kFlowSteps = 8;     // between remeshings
constexpr int kPolishRounds = 2;  // of averaging and Newton at the end

bool has_free_vertex(const FilmComplex& complex) {
  return std::any_of(complex.vertices.begin(), complex.vertices.end(),
                     [](const ComplexVertex& vertex) {
                       return vertex.kind == VertexKind::Free;
                     });
}

bool pinches(const FilmComplex& complex, double edge) {
  const FilmEnergy energy(complex);
  const Neck neck =
      narrowest_neck(energy, complex.mesh.points, complex.mesh.facet_label);
  return neck.surface >= 0 && neck.width < edge;
}

FilmState given_up(const FilmComplex& complex, const std::string& reason,
                   int steps) {
  const FilmEnergy energy(complex);
  FilmState state;
  state.points = complex.mesh.points;
  state.heights = VectorX::Zero(energy.unknowns());
  state.report.vertices = static_cast<int>(state.points.size());
  state.report.facets = static_cast<int>(energy.facets().size());
  const FilmTargets targets = targets_of(complex);
  state.report.energy = energy.value(state.points, targets);
  state.report.area = energy.area(state.points);
  state.report.iterations = steps;
  const VectorX volumes = energy.volumes(state.points);
  for (int b = 0; b < energy.bodies(); ++b) {
    const ComplexBody& body = complex.bodies[b];
    state.report.bodies.push_back({body.name, volumes[b],
                                   body.volume.value_or(volumes[b]),
                                   body.pressure.value_or(0.0)});
  }
  judge(energy, complex, {.reason = reason}, state);
  return state;
}

/// Flow and remeshing in turn. Empty when the film came near rest; else why
/// not.
std::string bring_near(FilmComplex& complex, std::optional<double> edge,
                       int rounds, int& steps, Monitor* monitor) {
  FlowOptions flow{.max_steps = kFlowSteps, .monitor = monitor};
  for (int round = 0; round < rounds; ++round) {
    const FlowReport report = flow_to_rest(complex, flow);
    steps += report.steps;
    if (edge) {
      remesh_films(complex, {.edge = *edge});
    }
    const double width = edge ? *edge : mean_edge_length(complex.mesh);
    if (pinches(complex, width)) {
      return "the film pinched while it flowed";
    }
    if (report.settled || report.steps == 0) {
      break;
    }
  }
  return "";
}

/// Coarse to fine over the edges edge x 2^k, k = levels..0. Empty when the
/// film came near rest; else why not.
std::string bring_near_by_levels(FilmComplex& complex,
                                 const FindOptions& options, int levels,
                                 int& steps) {
  for (int level = levels; level >= 0; --level) {
    std::optional<double> edge;
    if (options.edge) {
      edge = *options.edge * std::exp2(level);
      if (level < levels) {
        complex = refine(complex).complex;
      }
      remesh_films(complex, {.edge = *edge});
    }
    std::string reason = bring_near(complex, edge, options.max_rounds, steps,
                                    options.settle.monitor);
    if (!reason.empty()) {
      return reason;
    }
  }
  return "";
}

/// Newton, and vertex averaging so that facets are good where the film is.
FilmState settle_and_polish(FilmComplex& complex, const FindOptions& options,
                            int& steps) {
  if (!has_free_vertex(complex)) {
    throw InvalidInput(fmt::format(
        "the film has no vertex between its curves at a mean edge of {:.4g}; "
        "use a shorter edge",
        mean_edge_length(complex.mesh)));
  }
  FilmState state;
  for (int round = 0; round <= kPolishRounds; ++round) {
    if (round > 0) {
      equiangulate(complex);
      average_vertices(complex);
    }
    const FilmEnergy energy(complex);
    state = settle_in_normals(energy, complex, targets_of(complex),
                              complex.mesh.points, options.settle);
    steps += state.report.iterations;
    complex.mesh.points = state.points;
    if (state.failure || !options.edge) {
      break;
    }
  }
  return state;
}

}  // namespace

FilmState find_equilibrium(FilmComplex& complex, const FindOptions& options) {
  const Timer timer;
  int steps = 0;
  const int levels = options.edge ? options.halvings : 0;
  FilmComplex raw = complex;
  std::string reason = bring_near_by_levels(complex, options, levels, steps);
  if (!reason.empty() && levels > 0) {
    // A coarse film pinches earlier: the same without the coarse levels.
    for (int level = 0; level < levels; ++level) {
      raw = refine(raw).complex;
    }
    complex = std::move(raw);
    reason = bring_near_by_levels(complex, options, 0, steps);
  }
  FilmState state = reason.empty() ? settle_and_polish(complex, options, steps)
                                   : given_up(complex, reason, steps);
  state.report.iterations = steps;
  state.report.seconds = timer.seconds();
  return state;
}

}  // namespace meniscus
