#include "evolve/settle/bring_near.h"

#include <cmath>

#include "evolve/films/rim_grading.h"
#include "evolve/groom/remesh.h"
#include "evolve/settle/neck.h"

namespace meniscus::settle {

namespace {

constexpr int kFlowSteps = 8;         // between remeshings
constexpr int kLookAt = 2;            // steps between looks at the neck
constexpr double kMostGrowth = 50.0;  // of the area

/// The area beyond which a film is taken to grow without end.
double most_area(const films::FilmComplex& complex) {
  const energy::FilmEnergy energy(complex);
  double sum = energy.area(complex.mesh.points);
  for (const films::ComplexBody& body : complex.bodies) {
    sum += std::pow(std::abs(body.volume.value_or(0.0)), 2.0 / 3.0);
  }
  return kMostGrowth * sum;
}

}  // namespace

std::string bring_near(films::FilmComplex& complex, std::optional<double> edge,
                       int rounds, int& steps, FlowOptions flow) {
  flow.max_steps = kFlowSteps;
  int asked = 0;
  flow.torn = [&](const energy::FilmEnergy& energy, const Points& points) {
    if (flow.most_motion == 0.0 && ++asked % kLookAt != 0) {
      return false;
    }
    const Neck neck = narrowest_neck(energy, points, complex.mesh.facet_label);
    return neck.surface >= 0 &&
           neck.width < (edge ? *edge : energy.mean_edge(points));
  };
  const double limit = most_area(complex);
  for (int round = 0; round < rounds; ++round) {
    const FlowReport report = flow_to_rest(complex, flow);
    steps += report.steps;
    if (!(energy::FilmEnergy(complex).area(complex.mesh.points) < limit)) {
      return kFilmGrows;
    }
    if (report.torn) {
      return kFilmTears;
    }
    if (edge) {
      groom::remesh_films(
          complex,
          {.edge = *edge, .edge_field = films::graded_edge(complex, *edge)});
    }
    if (report.settled || report.steps == 0) {
      break;
    }
  }
  return "";
}

}  // namespace meniscus::settle
