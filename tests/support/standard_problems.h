/// Optimization problems with known answers, each with exact derivatives.
#pragma once

#include <string>
#include <vector>

#include "optimize/minimize.h"

namespace meniscus::tests {

struct StandardProblem {
  std::string name;
  optimize::MinimizeProblem problem;
  double least = 0.0;  // objective at the optimum
  VectorX solution;    // one of them
  bool equations = false;
};

/// Rosenbrock's valley; from W. Hock, K. Schittkowski, Test Examples for
/// Nonlinear Programming Codes, 1981: 6 (equation), 24, 35, 43 (Rosen and
/// Suzuki), 71 (both kinds); K. Svanberg's cantilever of five square tubes
/// (Int. J. Numer. Meth. Engng 24, 1987).
std::vector<StandardProblem> standard_problems();

/// Six humps of a camel, two of them lowest (L. C. W. Dixon, G. P. Szego,
/// Towards Global Optimisation 2, 1978), with a start in a poor valley;
/// `fenced`: x + y >= 0 as a constraint.
StandardProblem camel(double x, double y);
StandardProblem fenced_camel();

VectorX vector_of(std::initializer_list<double> numbers);

}  // namespace meniscus::tests
