/// The film alone: freezing from the curves, and the next design.
#include <cmath>

#include <benchmark/benchmark.h>

#include "evolve/frozen/film_model.h"

namespace meniscus {
namespace {

films::FilmSystem two_arm(double support_x) {
  const double s = std::sqrt(3.0) / 2.0;
  films::FilmSystem system;
  system.curves = {
      {"support", curves::Circle{Vec3(support_x, 0, 0), Vec3(0, 0, -1), 35}},
      {"left", curves::Circle{Vec3(-120, 0, 72), Vec3(-s, 0, 0.5), 50}},
      {"right", curves::Circle{Vec3(120, 0, 72), Vec3(s, 0, 0.5), 50}}};
  system.films = {
      {"skin", films::FilmKind::Branch, {"support", "left", "right"}, 1}};
  system.caps = {
      {"foot", "support"}, {"left_pad", "left"}, {"right_pad", "right"}};
  system.bodies = {
      {"part", {"skin", "foot", "left_pad", "right_pad"}, 1.7e6, {}}};
  return system;
}

double edge_of(const benchmark::State& state) {
  return static_cast<double>(state.range(0)) / 100.0;
}

void film_freeze(benchmark::State& state) {
  for (const auto& iteration : state) {
    static_cast<void>(iteration);
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        two_arm(0.0), {.edge = edge_of(state), .refinements = 1});
    state.counters["facets"] = model.reference().report.facets;
  }
}

void film_next_design(benchmark::State& state) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      two_arm(0.0), {.edge = edge_of(state), .refinements = 1});
  for (const auto& iteration : state) {
    static_cast<void>(iteration);
    benchmark::DoNotOptimize(model.settle(two_arm(2.0)));
  }
  state.counters["facets"] = model.reference().report.facets;
}

// Edges in hundredths of a millimetre.
BENCHMARK(film_freeze)
    ->Arg(1450)
    ->Arg(890)
    ->Arg(485)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(film_next_design)
    ->Arg(1450)
    ->Arg(890)
    ->Arg(485)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace meniscus
