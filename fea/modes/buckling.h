/// Linear buckling: K x = -lambda K_g x, K_g the geometric stiffness of a
/// solved load case's stresses. All loads times lambda make the part unstable,
/// as far as its displacements until then are small and the loads keep their
/// directions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/monitor.h"
#include "fea/elastic/elasticity.h"
#include "fea/modes/eigenpairs.h"

namespace meniscus::modes {

enum class LoadSense { AsGiven, Reversed };

struct BucklingOptions {
  int count = 1;            // smallest factors
  double tolerance = 1e-6;  // residual of each mode, see eigenpairs.h
  LoadSense sense = LoadSense::AsGiven;
  /// Factors above this are not looked for, which ends the search where little
  /// is compressed.
  double largest = 1e4;
  int guards = 2;  // see eigenpairs.h
  int max_iterations = 200;
  Monitor* monitor = nullptr;  // not owned
  /// Of the design, one per region, not owned; null: those of the model's base.
  const std::vector<element::Material>* materials = nullptr;
  /// Shapes of another design of the same mesh to begin with, not owned.
  const std::vector<VectorX>* start = nullptr;
  bool may_factor = false;  // see eigenpairs_of()
};

struct BucklingModes {
  /// Ascending, all positive; of LoadSense::Reversed for the reversed loads. A
  /// part that nothing compresses has none.
  std::vector<double> factors;
  /// Per factor, 3 per node: largest displacement of a node 1, the first of
  /// the largest components positive [1].
  std::vector<VectorX> shapes;
  std::vector<double> residuals;  // relative, per factor
  /// Without factors: the search saw none below this; `largest`, or less where
  /// it ended early.
  double none_below = 0.0;
  int iterations = 0;
  double seconds = 0.0;
  /// No convergence; what there is, is kept.
  std::optional<Failure> failure;
};

/// What the pairs of -K_g against K say, all but the shapes. `load_case`: its
/// name, for messages.
BucklingModes factors_of(const EigenPairs& pairs,
                         const BucklingOptions& options,
                         const std::string& load_case);

/// `displacement`: the solution of load case `load_case` (index) on `mesh`.
/// Throws what ElasticModel::operator_at() throws, and InvalidInput for sizes
/// and options out of range.
BucklingModes buckling_modes(const elastic::ElasticModel& model,
                             const TetMesh& mesh,
                             const std::vector<loads::LoadCase>& load_cases,
                             int load_case, const VectorX& displacement,
                             const BucklingOptions& options = {});

}  // namespace meniscus::modes
