#include <cmath>

#include "evolve/groom/refine.h"
#include "evolve/groom/remesh.h"
#include "evolve/settle/curvature_flow.h"
#include "evolve/start/start_complex.h"
#include "pipeline/frames/film_frames.h"

namespace meniscus::frames {

namespace {

// As a film is found, coarse first, but in steps small enough to see.
constexpr int kSteps = 30;          // at most, coarse and fine
constexpr double kSmoothing = 0.5;  // edges in the first step

}  // namespace

std::vector<forward::FilmFrame> settling_frames(
    const case_data::EvaluatedCase& inputs, const frozen::FilmModel& model,
    Monitor& monitor, int most) {
  films::FilmComplex complex =
      start::build_start(inputs.film_system, model.start_edge());
  std::vector<forward::FilmFrame> all;
  const auto keep = [&](const char* kept, SurfaceMesh surface) {
    all.push_back({.evaluation = static_cast<int>(all.size()),
                   .kept = kept,
                   .surface = std::move(surface)});
  };
  keep("raw", complex.mesh);
  settle::FlowOptions flow{
      .max_steps = kSteps, .smoothing = kSmoothing, .monitor = &monitor};
  flow.torn = [&](const energy::FilmEnergy&, const Points& points) {
    SurfaceMesh surface = complex.mesh;
    surface.points = points;
    keep("flowing", std::move(surface));
    return false;
  };
  // Long facets between the curves have nothing to flow with.
  groom::remesh_films(complex, {.edge = model.start_edge()});
  settle::flow_to_rest(complex, flow);
  if (model.start_edge() > inputs.fea_edge) {
    complex = groom::refine(complex).complex;
  }
  groom::remesh_films(complex, {.edge = inputs.fea_edge});
  settle::flow_to_rest(complex, flow);
  if (!model.reference().failure) {
    keep("settled", model.fine_mesh(model.reference().points));
  }
  std::vector<forward::FilmFrame> frames;
  const auto count = static_cast<int>(all.size());
  const int wanted = std::min(most, count);
  for (int k = 0; k < wanted; ++k) {
    const auto at = static_cast<std::size_t>(std::lround(
        static_cast<double>(k) * (count - 1) / std::max(wanted - 1, 1)));
    frames.push_back(std::move(all[at]));
  }
  return frames;
}

}  // namespace meniscus::frames
