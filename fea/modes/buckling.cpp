#include "fea/modes/buckling.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/equations/elastic_operator.h"
#include "fea/loads/body_loads.h"
#include "fea/modes/eigen_shapes.h"
#include "fea/modes/eigenpairs.h"

namespace meniscus::modes {

namespace {

void check_buckling(const TetMesh& mesh, const VectorX& displacement,
                    const BucklingOptions& options) {
  if (options.count < 1 || !(options.tolerance > 0.0) ||
      options.max_iterations < 1 || !(options.largest > 0.0)) {
    throw InvalidInput(fmt::format(
        "buckling: count is {}, tolerance {}, max_iterations {}, largest {}; "
        "all must be above 0",
        options.count, options.tolerance, options.max_iterations,
        options.largest));
  }
  if (displacement.size() != static_cast<Eigen::Index>(3 * mesh.nodes.size())) {
    throw InvalidInput(fmt::format("buckling: {} displacements for {} nodes",
                                   displacement.size(), mesh.nodes.size()));
  }
}

/// A of the eigenproblem: the stresses that weaken, turned with the loads.
solver::NodalMatrix weakening(const TetMesh& mesh,
                              const equations::ElasticOperator& op,
                              const loads::LoadCase& load_case,
                              const VectorX& displacement, LoadSense sense) {
  element::PointStress stress =
      element::point_stress(mesh, op.materials, displacement,
                            loads::temperature_change(mesh, load_case));
  if (sense == LoadSense::AsGiven) {
    for (element::Stress& s : stress.stress) {
      for (double& component : s) {
        component = -component;
      }
    }
  }
  return solver::geometric_stiffness(*op.table, op.x, op.order->element,
                                     stress);
}

}  // namespace

BucklingModes factors_of(const EigenPairs& pairs,
                         const BucklingOptions& options,
                         const std::string& load_case) {
  const double floor = 1.0 / options.largest;
  BucklingModes modes;
  modes.iterations = pairs.iterations;
  modes.failure =
      why_not(pairs, fmt::format("load case '{}': buckling", load_case));
  modes.none_below = options.largest;
  if (pairs.end == EigenEnd::TooManyIterations) {
    const double theta = pairs.theta[0];
    const double spread = pairs.residuals[0] * std::max(std::abs(theta), floor);
    if (theta <= spread) {  // nothing says that there is a factor at all
      modes.failure.reset();
      modes.none_below = 1.0 / std::max(theta + spread, floor);
      return modes;
    }
  }
  for (Eigen::Index k = 0; k < pairs.theta.size() && pairs.theta[k] >= floor;
       ++k) {
    modes.factors.push_back(1.0 / pairs.theta[k]);
    modes.residuals.push_back(pairs.residuals[k]);
  }
  return modes;
}

BucklingModes buckling_modes(const elastic::ElasticModel& model,
                             const TetMesh& mesh,
                             const std::vector<loads::LoadCase>& load_cases,
                             int load_case, const VectorX& displacement,
                             const BucklingOptions& options) {
  const Timer timer;
  check_buckling(mesh, displacement, options);
  const equations::ElasticOperator op =
      model.operator_at(mesh, load_cases, load_case, options.materials);
  const loads::LoadCase& loads = load_cases[load_case];
  const solver::NodalMatrix A =
      weakening(mesh, op, loads, displacement, options.sense);
  const EigenPairs pairs = eigenpairs_of(
      op, A, start_columns(*op.order, solver::Columns(), options.start),
      {.count = options.count,
       .tolerance = options.tolerance,
       .floor = 1.0 / options.largest,
       .guards = options.guards,
       .max_iterations = options.max_iterations,
       .monitor = options.monitor},
      options.may_factor);
  BucklingModes modes = factors_of(pairs, options, loads.name);
  for (std::size_t k = 0; k < modes.factors.size(); ++k) {
    const VectorX x = equations::to_mesh(
        *op.order, pairs.x.col(static_cast<Eigen::Index>(k)));
    modes.shapes.push_back(with_fixed_sign(x / largest_of_nodes(x)));
  }
  modes.seconds = timer.seconds();
  return modes;
}

}  // namespace meniscus::modes
