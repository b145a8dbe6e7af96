#include "optimize/differences.h"

#include <algorithm>
#include <array>

namespace meniscus::optimize {
namespace {

// The neighbours to try along variable j, best first, inside the bounds.
std::vector<VectorX> neighbours(const EvaluatorCore& core, const VectorX& x,
                                Eigen::Index j) {
  const double step = core.limits().difference_step * core.ranges()[j];
  const Variable& variable = core.variables()[static_cast<std::size_t>(j)];
  const double side = x[j] + step <= variable.upper ? step : -step;
  const std::array<double, 4> tries = {side, -side, 0.1 * side, -0.1 * side};
  std::vector<VectorX> points;
  points.reserve(tries.size());
  for (const double h : tries) {
    const double there = x[j] + h;
    if (there >= variable.lower && there <= variable.upper) {
      points.push_back(x);
      points.back()[j] = there;
    }
  }
  return points;
}

}  // namespace

std::optional<Eigen::MatrixXd> one_sided_differences(const EvaluatorCore& core,
                                                     const VectorX& x,
                                                     const VectorX& values,
                                                     const AskNeighbour& ask) {
  std::vector<std::vector<VectorX>> tries;
  std::vector<VectorX> first;
  tries.reserve(static_cast<std::size_t>(x.size()));
  first.reserve(static_cast<std::size_t>(x.size()));
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    tries.push_back(neighbours(core, x, j));
    if (static_cast<int>(first.size()) < core.evaluations_left()) {
      first.push_back(tries.back().front());
    }
  }
  if (core.limits().prefetch && first.size() > 1) {
    core.limits().prefetch(first);
  }
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(values.size(), x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    for (const VectorX& point : tries[static_cast<std::size_t>(j)]) {
      const Neighbour neighbour = ask(point);
      if (neighbour.halted) {
        return std::nullopt;
      }
      if (neighbour.values != nullptr) {
        jacobian.col(j) = (*neighbour.values - values) / (point[j] - x[j]);
        break;
      }
    }
  }
  return jacobian;
}

}  // namespace meniscus::optimize
