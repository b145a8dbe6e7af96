/// Assembly, set-up, first solve and next design of the elasticity solver on
/// solid bars. `peak_MB` is the whole process's so far: run one size at a time
/// (--benchmark_filter) to read it.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "fea/elastic/elasticity.h"
#include "tests/support/shapes.h"

namespace meniscus {
namespace {

struct Part {
  TetMesh base;
  TetMesh moved;  // about 1 % of the size away
  std::vector<element::Material> materials = {
      {"aluminium", 70000.0, 0.33, 2.7e-9, {}}};
  std::vector<loads::LoadCase> cases;
};

/// A bar of 2 x 1 x 1 with `cells` cells across: 12 cells^3 elements.
Part make_part(int cells, int load_cases) {
  Part part;
  part.base = shapes::straight_quadratic(
      shapes::brick({200.0, 100.0, 100.0}, 2 * cells, cells, cells));
  part.moved = shapes::sheared(part.base, 0.05);
  loads::LoadCase down{.name = "down",
                       .supports = {{"x0", true, true, true}},
                       .forces = {{"x1", {0.0, 0.0, -1000.0}}},
                       .pressures = {}};
  loads::LoadCase side = down;
  side.name = "side";
  side.forces[0].total = {0.0, 500.0, 100.0};
  part.cases = {down, side};
  part.cases.resize(load_cases);
  return part;
}

void report(benchmark::State& state, const Part& part,
            const equations::ElasticSolution& solution) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
  state.counters["elements"] = part.base.element_count();
  state.counters["dofs"] = solution.report.dofs;
  state.counters["iterations"] = solution.report.iterations;
  state.counters["setup_s"] = solution.report.setup_seconds;
  state.counters["solve_s"] = solution.report.solve_seconds;
  if (solution.failure) {
    state.SkipWithError(solution.failure->message.c_str());
  }
}

void first_solve(benchmark::State& state) {
  const Part part = make_part(static_cast<int>(state.range(0)),
                              static_cast<int>(state.range(1)));
  for (auto _ : state) {
    const elastic::ElasticModel model(part.base, part.materials, part.cases);
    report(state, part, model.base_solution());
  }
}

void next_design(benchmark::State& state) {
  const Part part = make_part(static_cast<int>(state.range(0)),
                              static_cast<int>(state.range(1)));
  const elastic::ElasticModel model(part.base, part.materials, part.cases);
  for (auto _ : state) {
    const equations::ElasticSolution solution = model.solve(part.moved);
    report(state, part, solution);
  }
}

void stress(benchmark::State& state) {
  const Part part = make_part(static_cast<int>(state.range(0)), 1);
  const VectorX u = flat(part.base.nodes);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        stress::recover_stress(part.base, part.materials, u));
  }
}

// 6,144, 20,736 and 111,132 elements.
BENCHMARK(first_solve)
    ->ArgsProduct({{8, 12, 21}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(next_design)
    ->ArgsProduct({{8, 12, 21}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(stress)->Arg(8)->Arg(12)->Arg(21)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace meniscus

BENCHMARK_MAIN();
