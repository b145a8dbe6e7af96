/// The solver petsc in 1, 2, ... processes beside the program's own, on the
/// parts of the elasticity table. petsc_bench [--scale S] [--processes N]
/// Ends with 1 where displacements differ or a process of two needs as much
/// memory as one alone.
#include <algorithm>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "core/timer.h"
#include "tests/support/bench_target.h"
#include "tests/support/elastic_race.h"
#include "tests/support/measured_child.h"

namespace meniscus {
namespace {

constexpr double kApart = 1e-8;        // displacements, of the largest
constexpr double kMemoryOfOne = 0.75;  // of a process of two, at full size

double largest_process(const equations::ElasticReport& report) {
  double largest = 0.0;
  for (const double bytes : report.process_memory) {
    largest = std::max(largest, bytes);
  }
  return largest;
}

std::string row(const std::string& name, double seconds,
                const equations::ElasticReport& report, double difference) {
  return fmt::format(
      "  {:12} {:7.1f} s (set-up {:.1f}, solve {:.1f}), {} iterations, most of "
      "a process {:.0f} MB, differs by {:.1e}\n",
      name, seconds, report.setup_seconds, report.solve_seconds,
      report.iterations, largest_process(report) / 1e6, difference);
}

std::string measure(const ElasticWork& work, double scale, int most) {
  const ElasticPart part = work.make(scale);
  std::string text;
  VectorX ours;
  BenchTargets targets;
  double of_one = 0.0;  // memory
  for (int processes = 0; processes <= most;
       processes = processes == 0 ? 1 : 2 * processes) {
    const Timer timer;
    const elastic::ElasticModel model(
        part.mesh, part.materials, {part.load_case},
        processes == 0 ? equations::ElasticOptions{}
                       : equations::ElasticOptions{
                             .solver = equations::SolverKind::Distributed,
                             .processes = processes});
    const double seconds = timer.seconds();
    const equations::ElasticSolution& solution = model.base_solution();
    if (solution.failure) {
      return text + solution.failure->message + "\n";
    }
    const VectorX& u = solution.displacements[0];
    const double memory = largest_process(solution.report);
    of_one = processes == 1 ? memory : of_one;
    if (processes == 2 && scale >= 1.0 && work.large) {
      targets.at_most(work.name + ", memory of one of two over one's",
                      memory / of_one, kMemoryOfOne);
    }
    if (processes == 0) {
      ours = u;
      text = fmt::format("{}: {} elements, {} unknowns\n", work.name,
                         part.mesh.element_count(), solution.report.dofs);
    }
    const double apart =
        (u - ours).lpNorm<Eigen::Infinity>() / ours.lpNorm<Eigen::Infinity>();
    text +=
        row(processes == 0 ? "p-multigrid" : fmt::format("petsc {}", processes),
            seconds, solution.report, apart);
    targets.at_most(work.name + ", displacements apart", apart, kApart);
  }
  return text + targets.told();
}

}  // namespace
}  // namespace meniscus

int main(int argc, char** argv) {
  double scale = 1.0;
  int processes = 2;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--scale") {
      scale = std::atof(argv[i + 1]);
    } else {
      processes = std::atoi(argv[i + 1]);
    }
  }
  bool missed = false;
  for (const meniscus::ElasticWork& work : meniscus::elastic_works()) {
    const meniscus::MeasuredChild child = meniscus::measure_forked(
        [&] { return meniscus::measure(work, scale, processes); });
    fmt::print("{}", child.output);
    std::fflush(stdout);
    missed =
        missed || !child.succeeded ||
        child.output.find(meniscus::BenchTargets::kMissed) != std::string::npos;
  }
  return missed ? 1 : 0;
}
