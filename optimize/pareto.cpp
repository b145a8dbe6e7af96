#include "optimize/pareto.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace meniscus::optimize {
namespace {

// a is at least as good everywhere, and better somewhere or earlier.
bool beats(const VectorX& a, const VectorX& b, bool earlier) {
  return (a.array() <= b.array()).all() &&
         (earlier || (a.array() < b.array()).any());
}

ResponseBounds& constraint_of(MinimizeProblem& problem, int index) {
  if (index < 0 || index >= static_cast<int>(problem.constraints.size())) {
    throw InvalidInput(fmt::format(
        "pareto: constraint {} of {}; the second objective has to be among "
        "them",
        index, problem.constraints.size()));
  }
  return problem.constraints[static_cast<std::size_t>(index)];
}

}  // namespace

std::vector<int> pareto_front(const std::vector<VectorX>& points) {
  std::vector<int> front;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].size() != points[0].size() || points[i].hasNaN()) {
      throw InvalidInput(fmt::format(
          "pareto: point {} has {} objectives{}; expected {} numbers", i,
          points[i].size(), points[i].hasNaN() ? ", one of them NaN" : "",
          points[0].size()));
    }
    bool beaten = false;
    for (std::size_t j = 0; j < points.size() && !beaten; ++j) {
      beaten = j != i && beats(points[j], points[i], j < i);
    }
    if (!beaten) {
      front.push_back(static_cast<int>(i));
    }
  }
  return front;
}

VectorX epsilon_levels(double best, double worst, int count) {
  if (count < 1 || !(best <= worst)) {
    throw InvalidInput(
        fmt::format("pareto: {} levels between {} and {}; expected at least "
                    "one, and the best value first",
                    count, best, worst));
  }
  VectorX levels(count);
  for (int k = 0; k < count; ++k) {
    levels[k] = worst + (best - worst) * (k + 1) / (count + 1);
  }
  return levels;
}

MinimizeProblem with_upper_bound(const MinimizeProblem& problem, int index,
                                 double level) {
  MinimizeProblem bounded = problem;
  ResponseBounds& constraint = constraint_of(bounded, index);
  constraint.upper = std::min(constraint.upper, level);
  return bounded;
}

MinimizeProblem exchanged(const MinimizeProblem& problem, int index) {
  MinimizeProblem other = problem;
  const ResponseBounds& second =
      problem.constraints[static_cast<std::size_t>(index)];
  constraint_of(other, index) = {.name = problem.objective,
                                 .shown = problem.shown};
  other.objective = second.name;
  other.shown = second.shown;
  const Eigen::Index row = index + 1;
  other.function = [inner = problem.function, row](const VectorX& x) {
    VectorAnswer answer = inner(x);
    if (answer.values.size() > row) {
      std::swap(answer.values[0], answer.values[row]);
    }
    return answer;
  };
  if (problem.jacobian) {
    other.jacobian = [inner = problem.jacobian, row](const VectorX& x) {
      JacobianAnswer answer = inner(x);
      if (answer.jacobian.rows() > row) {
        answer.jacobian.row(0).swap(answer.jacobian.row(row));
      }
      return answer;
    };
  }
  return other;
}

}  // namespace meniscus::optimize
