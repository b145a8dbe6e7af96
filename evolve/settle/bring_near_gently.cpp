#include "evolve/settle/bring_near_gently.h"

#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "evolve/groom/flip_average.h"
#include "evolve/groom/refine.h"
#include "evolve/groom/rough_films.h"
#include "evolve/settle/curvature_flow.h"
#include "evolve/start/hull.h"

namespace meniscus::settle {

namespace {

constexpr int kGentleRounds = 2;       // of flips and flow, each level
constexpr int kGentleFlows = 12;       // a round
constexpr int kGentleSteps = 5;        // of a flow, then facets are evened out
constexpr double kGentleSmooth = 1.0;  // edges, in the first step of a flow
constexpr double kGentleMotion = 0.5;  // x mean edge, per step

/// Volume of the convex hull of a body's facets; none where they are flat.
std::optional<double> hull_volume(const films::FilmComplex& complex,
                                  const energy::FilmEnergy& energy, int body) {
  std::vector<char> used(complex.mesh.points.size(), 0);
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    for (const int v : complex.mesh.facets[f]) {
      used[v] |= energy.side(static_cast<int>(f), body) != 0 ? 1 : 0;
    }
  }
  SurfaceMesh hull;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] != 0) {
      hull.points.push_back(complex.mesh.points[v]);
    }
  }
  try {
    hull.facets = start::convex_hull(hull.points);
  } catch (const MeshError&) {
    return {};
  }
  return enclosed_volume(hull);
}

/// Asks bodies for their hull's volume where that is more. False: nowhere.
bool blow_up(films::FilmComplex& complex) {
  const energy::FilmEnergy energy(complex);
  const VectorX volumes = energy.volumes(complex.mesh.points);
  bool any = false;
  for (int b = 0; b < std::ssize(complex.bodies); ++b) {
    films::ComplexBody& body = complex.bodies[b];
    const double asked = body.volume.value_or(volumes[b]);
    const std::optional<double> whole = hull_volume(complex, energy, b);
    if (whole && *whole > std::abs(asked)) {
      body.volume = std::copysign(*whole, asked);
      body.pressure.reset();
      any = true;
    }
  }
  return any;
}

void flow_and_groom(films::FilmComplex& complex, Monitor* monitor, int& steps) {
  for (int round = 0; round < kGentleRounds; ++round) {
    groom::equiangulate(complex, groom::FlipRule::AnglesOnly);
    groom::average_vertices(complex);
    for (int k = 0; k < kGentleFlows; ++k) {
      const FlowReport flow = flow_to_rest(
          complex,
          {.max_steps = kGentleSteps,
           .smoothing = kGentleSmooth,
           .most_motion = kGentleMotion * mean_edge_length(complex.mesh),
           .short_volume_steps = true,
           .monitor = monitor});
      steps += flow.steps;
      groom::even_out(complex, groom::EvenOut::Flips);
      if (flow.settled || flow.steps == 0) {
        break;
      }
    }
  }
}

}  // namespace

int bring_near_gently(films::FilmComplex& complex, const GentleOptions& options,
                      int& steps) {
  std::vector<films::ComplexBody> asked = complex.bodies;
  const bool blown = blow_up(complex);
  int left = options.refinements;
  flow_and_groom(complex, options.monitor, steps);
  while (left > 0 && 4 * complex.mesh.facets.size() <= options.most_facets) {
    complex = groom::refine(complex).complex;
    --left;
    flow_and_groom(complex, options.monitor, steps);
  }
  if (blown) {
    complex.bodies = std::move(asked);
    flow_and_groom(complex, options.monitor, steps);
  }
  return left;
}

}  // namespace meniscus::settle
