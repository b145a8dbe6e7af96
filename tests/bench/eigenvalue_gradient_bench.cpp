/// What the gradients of a buckling factor and of a frequency cost beside a
/// solve of the same design, and their evaluation beside one without; prints
/// the table of docs/performance.md and ends with 1 where a target is missed.
/// eigenvalue_gradient_bench [EDGE]: of elements in mm, 2 when left out.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>

#include "core/memory.h"
#include "core/process_settings.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/reader/case_reader.h"
#include "tests/support/bench_target.h"

namespace meniscus {
namespace {

constexpr int kRuns = 3;
constexpr double kMostSolves = 3.0;

std::string column(double edge) {
  return fmt::format(R"(title = "A column"
units = "mm-N-MPa"

[design.w]
initial = 10.0
bounds = [6.0, 20.0]

[curves.low]
kind = "polygon"
points = [[0, 0, 0], ["w", 0, 0], ["w", 10, 0], [0, 10, 0]]

[curves.high]
kind = "polygon"
points = [[0, 0, 150], ["w", 0, 150], ["w", 10, 150], [0, 10, 150]]

[solids.foot]
kind = "cap"
curve = "low"

[solids.sides]
kind = "sides"
curves = ["low", "high"]

[solids.top]
kind = "cap"
curve = "high"

[bodies.part]
enclosed_by = ["foot", "sides", "top"]
material = "steel"

[resolution]
fea = {}

[materials.steel]
youngs_modulus = 210000.0
poisson_ratio = 0.3
density = 7.85e-9

[load_cases.push]
supports = [{{ on = "foot", fix = "xyz" }}]
loads = [{{ on = "top", force = [0, 0, -2000] }}]

[responses.stable]
kind = "buckling_factor"

[responses.hum]
kind = "frequency"

[study]
kind = "analyse"
)",
                     edge);
}

struct Cost {
  int unknowns = 0;
  int solves = 0;
  double solve = HUGE_VAL;
  double evaluation = HUGE_VAL;
  double gradient[2] = {HUGE_VAL, HUGE_VAL};  // of each response
};

Cost cost_of(double edge) {
  const reader::CaseReading reading =
      reader::read_case_text(column(edge), "case.toml");
  if (!reading.input) {
    throw std::runtime_error(reading.problems.front());
  }
  const forward::ForwardModel model(*reading.input);
  const VectorX design = VectorX::Constant(1, 10.05);
  Cost cost;
  for (int k = 0; k < kRuns; ++k) {
    forward::EvaluationFields fields;
    forward::AdjointState adjoint;
    const forward::Evaluation there = model.evaluate(design, &fields, &adjoint);
    if (there.failure) {
      throw std::runtime_error(there.failure->message);
    }
    cost.unknowns = there.fea.dofs;
    cost.solve =
        std::min(cost.solve, there.fea.solve_seconds + there.fea.setup_seconds);
    cost.evaluation = std::min(cost.evaluation, there.seconds.fea);
    for (int r = 0; r < 2; ++r) {
      const forward::DesignGradient found =
          model.gradient(there, fields, adjoint, {r});
      cost.solves = std::max(cost.solves, found.solves);
      cost.gradient[r] = std::min(cost.gradient[r], found.seconds);
    }
  }
  return cost;
}

}  // namespace
}  // namespace meniscus

int main(int argc, char** argv) {
  meniscus::start_with_settings(argv);  // as the program does
  meniscus::keep_freed_memory();
  const meniscus::Cost cost =
      meniscus::cost_of(argc > 1 ? std::atof(argv[1]) : 2.0);
  std::printf(
      "| unknowns | solve [s] | evaluation with modes | gradient of the factor "
      "| of the frequency |\n|---|---|---|---|---|\n| %d | %.2f | x %.2f | x "
      "%.2f | x %.2f |\n",
      cost.unknowns, cost.solve, cost.evaluation / cost.solve,
      cost.gradient[0] / cost.solve, cost.gradient[1] / cost.solve);
  meniscus::BenchTargets targets;
  targets.at_most("adjoint solves", cost.solves, 1.0);
  targets.at_most("gradient of a factor, in solves",
                  cost.gradient[0] / cost.solve, meniscus::kMostSolves);
  targets.at_most("gradient of a frequency, in solves",
                  cost.gradient[1] / cost.solve, meniscus::kMostSolves);
  return targets.finish();
}
