/// What the gradient of one response costs beside evaluations, for 1, 20 and
/// 200 design variables of the same part; prints the table of
/// docs/performance.md. gradient_bench [LENGTH]: of the part in mm, 120 when
/// left out.
#include <cstdio>
#include <cstdlib>

#include "core/memory.h"
#include "core/thread_waits.h"
#include "tests/support/gradient_cost.h"
#include "tests/support/rim_case.h"

int main(int argc, char** argv) {
  using meniscus::GradientCost;
  meniscus::wait_asleep(argv);  // as the program does
  meniscus::keep_freed_memory();
  const int points = argc > 1 ? std::atoi(argv[1]) : 200;
  constexpr double kLength = 30.0;  // [mm]
  constexpr int kRuns = 3;
  std::printf(
      "| variables | unknowns | cold [s] | next [s] | gradient [s] | of cold "
      "(1.0) | of next (2.0) |\n|---|---|---|---|---|---|---|\n");
  for (const int variables : {1, points / 10, points}) {
    const GradientCost cost = meniscus::gradient_cost(
        meniscus::rim_case(points, variables, kLength), kRuns);
    std::printf("| %d | %d | %.2f | %.2f | %.2f | %.2f | %.2f |\n", variables,
                cost.unknowns, cost.cold, cost.next, cost.gradient,
                cost.gradient / cost.cold, cost.gradient / cost.next);
    std::fflush(stdout);
  }
  return 0;
}
