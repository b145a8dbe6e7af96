/// What the gradient of one response costs beside evaluations, for one design
/// variable, a tenth of the points' and one a point of the same part; prints
/// the table of docs/performance.md and ends with 1 where a target is missed.
/// gradient_bench [POINTS [EDGE]]: of its rims, 200 when left out; the longest
/// edge of elements in mm, 20 when left out.
#include <cstdio>
#include <cstdlib>

#include "core/memory.h"
#include "core/process_settings.h"
#include "tests/support/bench_target.h"
#include "tests/support/gradient_cost.h"
#include "tests/support/rim_case.h"

int main(int argc, char** argv) {
  using meniscus::GradientCost;
  meniscus::start_with_settings(argv);  // as the program does
  meniscus::keep_freed_memory();
  const int points = argc > 1 ? std::atoi(argv[1]) : 200;
  const double edge = argc > 2 ? std::atof(argv[2]) : 20.0;
  constexpr double kLength = 30.0;  // [mm]
  constexpr int kRuns = 3;
  constexpr double kMostOfCold = 1.0;
  constexpr double kMostOfNext = 2.0;
  meniscus::BenchTargets targets;
  std::printf(
      "| variables | unknowns | cold [s] | next [s] | gradient [s] | of cold "
      "(1.0) | of next (2.0) |\n|---|---|---|---|---|---|---|\n");
  for (const int variables : {1, points / 10, points}) {
    const GradientCost cost = meniscus::gradient_cost(
        meniscus::rim_case(points, variables, kLength, edge), kRuns);
    std::printf("| %d | %d | %.2f | %.2f | %.2f | %.2f | %.2f |\n", variables,
                cost.unknowns, cost.cold, cost.next, cost.gradient,
                cost.gradient / cost.cold, cost.gradient / cost.next);
    std::fflush(stdout);
    const std::string name = std::to_string(variables) + " variables, ";
    targets.at_most(name + "of cold", cost.gradient / cost.cold, kMostOfCold);
    targets.at_most(name + "of next", cost.gradient / cost.next, kMostOfNext);
  }
  return targets.finish();
}
