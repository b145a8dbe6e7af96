#include "fea/buckling.h"

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/body_loads.h"
#include "fea/eigen_shapes.h"
#include "fea/eigenpairs.h"
#include "fea/elastic_operator.h"

namespace meniscus {

namespace {

void check(const TetMesh& mesh, const VectorX& displacement,
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
NodalMatrix weakening(const TetMesh& mesh, const ElasticOperator& op,
                      const LoadCase& load_case, const VectorX& displacement,
                      LoadSense sense) {
  PointStress stress = point_stress(mesh, *op.materials, displacement,
                                    temperature_change(mesh, load_case));
  if (sense == LoadSense::AsGiven) {
    for (Stress& s : stress.stress) {
      for (double& component : s) {
        component = -component;
      }
    }
  }
  return geometric_stiffness(*op.table, op.x, op.order->element, stress);
}

}  // namespace

BucklingModes buckling_modes(const ElasticModel& model, const TetMesh& mesh,
                             const std::vector<LoadCase>& load_cases,
                             int load_case, const VectorX& displacement,
                             const BucklingOptions& options) {
  const Timer timer;
  check(mesh, displacement, options);
  const ElasticOperator op = model.operator_at(mesh, load_cases, load_case);
  const LoadCase& loads = load_cases[load_case];
  const NodalMatrix A = weakening(mesh, op, loads, displacement, options.sense);
  const EigenPairs pairs = largest_eigenpairs(
      {op.table->pattern, op.K, A, *op.preconditioner, op.freedom}, Columns(),
      {.count = options.count,
       .tolerance = options.tolerance,
       .floor = 1.0 / options.largest,
       .max_iterations = options.max_iterations,
       .monitor = options.monitor});
  BucklingModes modes;
  modes.failure =
      why_not(pairs, fmt::format("load case '{}': buckling", loads.name));
  modes.iterations = pairs.iterations;
  for (Eigen::Index k = 0; k < pairs.theta.size(); ++k) {
    if (!(pairs.theta[k] * options.largest >= 1.0)) {
      break;
    }
    modes.factors.push_back(1.0 / pairs.theta[k]);
    modes.residuals.push_back(pairs.residuals[k]);
    const VectorX x = to_mesh(*op.order, pairs.x.col(k));
    modes.shapes.push_back(with_fixed_sign(x / largest_of_nodes(x)));
  }
  modes.seconds = timer.seconds();
  return modes;
}

}  // namespace meniscus
