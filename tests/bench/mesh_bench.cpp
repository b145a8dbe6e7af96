// The mesher side by side with the program tetgen, then seconds of tet meshing,
// quadratic elements and mesh motion. `--race` leaves the latter out.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>

#include <benchmark/benchmark.h>

#include "core/process_settings.h"
#include "mesh_tet/mesh_motion.h"
#include "mesh_tet/quadratic.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/bench_target.h"
#include "tests/support/mesh_race.h"
#include "tests/support/shapes.h"

namespace {

using namespace meniscus;

constexpr double kVolume = 1.7e6;  // of the two-arm bracket [mm^3]

SurfaceMesh ball(int levels) {
  return shapes::sphere(std::cbrt(kVolume * 3.0 / (4.0 * std::numbers::pi)),
                        levels);
}

/// A ball of `levels` refinements; elements of an edge in 1/100 mm.
void fill_ball(benchmark::State& state, int levels) {
  const SurfaceMesh surface = ball(levels);
  mesh_tet::Tetrahedralization result;
  for (auto _ : state) {
    result = mesh_tet::tetrahedralize(
        surface, {.edge = static_cast<double>(state.range(0)) / 100.0});
  }
  state.counters["tets"] = result.mesh.element_count();
  state.counters["min_dihedral"] = result.quality.min_dihedral_deg;
  state.counters["tetgen_s"] = result.tetgen_seconds;
}
// 5,120 facets.
BENCHMARK_CAPTURE(fill_ball, bracket_volume, 4)
    ->Arg(485)
    ->Arg(870)
    ->Arg(1380)
    ->Unit(benchmark::kMillisecond);
// 20,480 facets, elements of the surface's own size and coarser.
BENCHMARK_CAPTURE(fill_ball, fine_surface, 5)
    ->Arg(485)
    ->Arg(285)
    ->Unit(benchmark::kMillisecond);

struct Model {
  SurfaceMesh surface = ball(4);
  TetMesh mesh = mesh_tet::tetrahedralize(surface, {.edge = 4.85}).mesh;
};

const Model& model() {
  static const Model kModel;
  return kModel;
}

void motion_setup(benchmark::State& state) {
  const Model& m = model();
  for (auto _ : state) {
    const mesh_tet::MeshMotion motion(
        m.mesh, static_cast<int>(m.surface.points.size()));
    benchmark::DoNotOptimize(&motion);
  }
}
BENCHMARK(motion_setup)->Unit(benchmark::kMillisecond);

void motion_move(benchmark::State& state) {
  const Model& m = model();
  const mesh_tet::MeshMotion motion(m.mesh,
                                    static_cast<int>(m.surface.points.size()));
  for (auto _ : state) {
    benchmark::DoNotOptimize(motion.move(m.surface.points));
  }
}
BENCHMARK(motion_move)->Unit(benchmark::kMillisecond);

QuadraticSurface curved(const SurfaceMesh& base) {
  QuadraticSurface surface;
  surface.base = base;
  list_edges(base.facets, surface.edges, surface.facet_edges);
  for (const Edge& e : surface.edges) {
    surface.mid.push_back(base.points[e[0]].norm() *
                          (base.points[e[0]] + base.points[e[1]]).normalized());
  }
  return surface;
}

void quadratic_make(benchmark::State& state) {
  const QuadraticSurface surface = curved(model().surface);
  for (auto _ : state) {
    benchmark::DoNotOptimize(mesh_tet::make_quadratic(model().mesh, surface));
  }
}
BENCHMARK(quadratic_make)->Unit(benchmark::kMillisecond);

void quadratic_move_and_check(benchmark::State& state) {
  const QuadraticSurface surface = curved(model().surface);
  std::vector<char> curve;
  TetMesh mesh = mesh_tet::make_quadratic(model().mesh, surface, &curve);
  for (auto _ : state) {
    mesh_tet::move_quadratic(mesh, model().mesh.nodes, surface, curve);
    benchmark::DoNotOptimize(mesh_tet::find_inverted(mesh));
  }
}
BENCHMARK(quadratic_move_and_check)->Unit(benchmark::kMillisecond);

int race() {
  constexpr double kMostOfPeer = 1.3;
  BenchTargets targets;
  constexpr int kRuns = 15;
  constexpr double kMega = 1e6;
  std::printf(
      "CPU seconds (user and system), one thread, the least of %d runs in "
      "turn;\n"
      "ratio: the median of the pairs.\n"
      "%-8s %9s %8s | %8s %8s %7s | %8s %8s | %6s %6s\n",
      kRuns, "part", "facets", "tets", "ours", "helper", "MB", "tetgen",
      "itself", "ratio", "angle");
  if (!have_tetgen()) {
    targets.holds("the program tetgen is here", false,
                  "install the Debian package tetgen");
    return targets.finish();
  }
  for (const MeshWork& work : mesh_works()) {
    const auto [own, peer, ratio] = race_mesher(work, kRuns);
    if (!own.succeeded || !peer.succeeded) {
      targets.holds(work.name + " is filled", false,
                    own.succeeded ? peer.message : own.message);
      continue;
    }
    std::printf(
        "%-8s %9zu %8d | %8.3f %8.3f %7.0f | %8.3f %8.3f | %6.2f %6.1f\n",
        work.name.c_str(), work.surface.facets.size(), own.elements,
        own.seconds, own.tetgen_seconds, own.peak_bytes / kMega, peer.seconds,
        peer.tetgen_seconds, ratio, own.min_dihedral_deg);
    targets.at_most(work.name + ", over tetgen's time", ratio, kMostOfPeer);
  }
  return targets.finish();
}

}  // namespace

int main(int argc, char** argv) {
  meniscus::start_with_settings(argv);  // as the program does
  const int missed = race();
  if (argc > 1 && std::strcmp(argv[1], "--race") == 0) {
    return missed;
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return missed;
}
