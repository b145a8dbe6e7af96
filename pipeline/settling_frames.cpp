#include <cmath>

#include "evolve/curvature_flow.h"
#include "evolve/grooming.h"
#include "pipeline/film_frames.h"

namespace meniscus {

namespace {

// Flow, meshing anew, flow: as a film is found, in steps small enough to see.
constexpr int kRounds = 3;
constexpr int kSteps = 20;
constexpr double kSmoothing = 1.0;  // edges in the first step

}  // namespace

std::vector<FilmFrame> settling_frames(const EvaluatedCase& numbers,
                                       const FilmModel& model, Monitor& monitor,
                                       int most) {
  FilmComplex complex = build_start(numbers.film_system, numbers.fea_edge);
  std::vector<FilmFrame> all;
  const auto keep = [&](const char* kept, SurfaceMesh surface) {
    all.push_back({.evaluation = static_cast<int>(all.size()),
                   .kept = kept,
                   .surface = std::move(surface)});
  };
  keep("raw", complex.mesh);
  FlowOptions flow{
      .max_steps = kSteps, .smoothing = kSmoothing, .monitor = &monitor};
  flow.torn = [&](const FilmEnergy&, const Points& points) {
    SurfaceMesh surface = complex.mesh;
    surface.points = points;
    keep("flowing", std::move(surface));
    return false;
  };
  bool settled = false;
  for (int round = 0; round < kRounds && !settled; ++round) {
    throw_if_stopped(monitor, "film");
    settled = flow_to_rest(complex, flow).settled;
    remesh_films(complex, {.edge = numbers.fea_edge});
  }
  if (!model.reference().failure) {
    keep("settled", model.fine_mesh(model.reference().points));
  }
  std::vector<FilmFrame> frames;
  const auto count = static_cast<int>(all.size());
  const int wanted = std::min(most, count);
  for (int k = 0; k < wanted; ++k) {
    const auto at = static_cast<std::size_t>(std::lround(
        static_cast<double>(k) * (count - 1) / std::max(wanted - 1, 1)));
    frames.push_back(std::move(all[at]));
  }
  return frames;
}

}  // namespace meniscus
