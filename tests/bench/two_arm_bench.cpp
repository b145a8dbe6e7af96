/// Seconds and memory of every stage on the two-arm bracket, at about 5k, 20k
/// and 115k ten-node tetrahedra; prints the table of docs/performance.md and
/// ends with 1 where a target is missed.
#include <array>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/process_settings.h"
#include "core/timer.h"
#include "fea/stress/stress.h"
#include "mesh_tet/tetrahedralize.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/reader/case_reader.h"
#include "tests/support/bench_target.h"

namespace meniscus {
namespace {

constexpr std::array<const char*, 3> kEdges = {"14.5", "8.9", "4.95"};
constexpr double kNextDesign = 2.0;  // mm from the frozen one

struct Row {
  const char* name;
  double target;  // at the largest size; 0: none
  std::array<double, 3> values;
};
std::vector<Row> rows = {
    {"film facets", 0, {}},
    {"ten-node tetrahedra", 0, {}},
    {"unknowns", 0, {}},
    {"film: start, grooming, equilibrium, freezing [s]", 1.5, {}},
    {"surface check, TetGen, improvement [s]", 2.0, {}},
    {"elasticity: first model and solve [s]", 8.0, {}},
    {"next design: film [s]", 0, {}},
    {"next design: mesh motion [s]", 0, {}},
    {"next design: assembly [s]", 1.0, {}},
    {"next design: solve [s]", 0, {}},
    {"next design, all [s]", 6.0, {}},
    {"stress recovery [s]", 0, {}},
    {"peak memory [MB]", 1500, {}},
};

double peak_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) {
      return std::stod(line.substr(6)) / 1024.0;
    }
  }
  return 0.0;
}

void two_arm(benchmark::State& state) {
  const auto size = static_cast<std::size_t>(state.range(0));
  const std::string edge = kEdges[size];
  const std::string film = std::to_string(std::stod(edge) / 2.0);
  const case_data::Case input =
      reader::read_case(MENISCUS_SOURCE_DIR "/cases/two_arm/case.toml",
                        {"resolution.fea=" + edge, "resolution.film=" + film});
  for (const auto& iteration : state) {
    static_cast<void>(iteration);
    const forward::ForwardModel model(input);
    if (model.failure()) {
      state.SkipWithError(model.failure()->message.c_str());
      return;
    }
    const forward::Evaluation& base = model.frozen();
    forward::EvaluationFields fields;
    const Timer timer;
    const forward::Evaluation next =
        model.evaluate(VectorX::Constant(1, kNextDesign), &fields);
    const double seconds = timer.seconds();
    const Timer stress_timer;
    benchmark::DoNotOptimize(
        stress::recover_stress(fields.mesh, fields.inputs.materials,
                               fields.solution.displacements.front()));
    const double stress = stress_timer.seconds();
    const std::array<double, 13> values = {
        static_cast<double>(next.film.facets),
        static_cast<double>(next.tet.elements),
        static_cast<double>(next.fea.dofs),
        base.seconds.film,
        base.seconds.mesh,
        base.seconds.fea,
        next.seconds.film,
        next.seconds.mesh,
        next.fea.setup_seconds,
        next.fea.solve_seconds,
        seconds,
        stress,
        peak_megabytes()};
    for (std::size_t k = 0; k < rows.size(); ++k) {
      rows[k].values[size] = values[k];
      state.counters[rows[k].name] = values[k];
    }
  }
}
// Ascending, so that the peak is each size's own.
BENCHMARK(two_arm)->DenseRange(0, 2)->Iterations(1)->Unit(benchmark::kSecond);

void print_table() {
  std::printf(
      "\n| two-arm bracket | 5k | 20k | 115k | target |\n"
      "|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    std::printf("| %s |", row.name);
    for (const double value : row.values) {
      std::printf(value >= 100 ? " %.0f |" : " %.2f |", value);
    }
    std::printf(row.target > 0 ? " %g |\n" : " |\n", row.target);
  }
}

int judge() {
  BenchTargets targets;
  for (const Row& row : rows) {
    if (row.target > 0 && row.values.back() > 0) {
      targets.at_most(row.name, row.values.back(), row.target);
    }
  }
  return targets.finish();
}

}  // namespace
}  // namespace meniscus

int main(int argc, char** argv) {
  meniscus::start_with_settings(argv);  // as the program does
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  meniscus::print_table();
  return meniscus::judge();
}
