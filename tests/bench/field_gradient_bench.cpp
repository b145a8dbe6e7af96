/// What the gradient of one response costs as a tension field of space has 1,
/// 10, 100 and 500 coefficients, each a design variable; prints the table of
/// docs/performance.md and ends with 1 where a target is missed.
/// field_gradient_bench [EDGE]: of elements in mm, 2 when left out.
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "core/memory.h"
#include "core/process_settings.h"
#include "tests/support/bench_target.h"
#include "tests/support/field_case.h"
#include "tests/support/gradient_cost.h"

int main(int argc, char** argv) {
  using meniscus::GradientCost;
  meniscus::start_with_settings(argv);  // as the program does
  meniscus::keep_freed_memory();
  const double edge = argc > 1 ? std::atof(argv[1]) : 2.0;
  constexpr int kRuns = 5;
  constexpr double kFlat = 1.15;  // of the gradient by one coefficient
  meniscus::BenchTargets targets;
  std::printf(
      "| coefficients | unknowns | next [s] | gradient [s] | of one "
      "coefficient's (1.15) |\n|---|---|---|---|---|\n");
  double one = 0.0;
  for (const auto& [along, around] : {std::pair{1, 1}, std::pair{5, 2},
                                      std::pair{20, 5}, std::pair{50, 10}}) {
    const GradientCost cost = meniscus::gradient_cost(
        meniscus::field_case(along, around, edge), kRuns);
    one = one > 0.0 ? one : cost.gradient;
    std::printf("| %d | %d | %.2f | %.2f | %.2f |\n", along * around,
                cost.unknowns, cost.next, cost.gradient, cost.gradient / one);
    std::fflush(stdout);
    targets.at_most(fmt::format("{} coefficients", along * around),
                    cost.gradient / one, kFlat);
  }
  return targets.finish();
}
