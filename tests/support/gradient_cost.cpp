#include "tests/support/gradient_cost.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/timer.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/reader/case_reader.h"

namespace meniscus {

namespace {

void require(const std::optional<Failure>& failure) {
  if (failure) {
    throw std::runtime_error(failure->message);
  }
}

}  // namespace

GradientCost gradient_cost(const std::string& case_text, int runs) {
  const reader::CaseReading reading =
      reader::read_case_text(case_text, "case.toml");
  if (!reading.input) {
    throw std::runtime_error(reading.problems.front());
  }
  const case_data::Case& input = *reading.input;
  const VectorX initial = case_data::initial_design(input);
  GradientCost cost{.cold = HUGE_VAL, .next = HUGE_VAL, .gradient = HUGE_VAL};
  for (int i = 0; i < runs; ++i) {
    const Timer cold;
    const forward::ForwardModel model(input);
    require(model.failure());
    require(model.evaluate(initial).failure);
    cost.cold = std::min(cost.cold, cold.seconds());

    forward::EvaluationFields fields;
    forward::AdjointState adjoint;
    const Timer next;
    const forward::Evaluation there =
        model.evaluate(1.01 * initial, &fields, &adjoint);
    cost.next = std::min(cost.next, next.seconds());
    require(there.failure);
    cost.unknowns = there.fea.dofs;

    const Timer timer;
    const forward::DesignGradient found =
        model.gradient(there, fields, adjoint, {0});
    cost.gradient = std::min(cost.gradient, timer.seconds());
    require(found.failure);
  }
  return cost;
}

}  // namespace meniscus
