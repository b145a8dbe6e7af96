/// How far a point is from the first-order conditions of a minimum (Karush,
/// Kuhn, Tucker), in numbers that do not depend on units.
#pragma once

#include "core/types.h"

namespace meniscus::optimize {

/// All at one point x.
struct FirstOrderInput {
  VectorX x;
  VectorX lower;  // of x; lower < upper
  VectorX upper;
  VectorX ranges;            // units of x, > 0; empty: upper - lower
  VectorX values;            // objective, then constraints
  Eigen::MatrixXd jacobian;  // d value_i / d x_j
  VectorX constraint_lower;  // may be -infinity
  VectorX constraint_upper;  // may be +infinity
  VectorX constraint_scale;  // what counts as one unit of violation, > 0
  /// What counts as one unit of objective, > 0; 0: its largest change
  /// |d f / d x_j| range_j.
  double objective_scale = 0.0;
};

/// With s_j = x_j / range_j the multipliers solve
///   min |f_s + sum_i m_i c_i,s + bounds|^2 + sum_i (m_i slack_i)^2,
/// of the sign that each side allows (least squares, Lawson & Hanson, Solving
/// Least Squares Problems, 1974, algorithm NNLS). The residual is the larger
/// of the largest entry of the first term and of the largest m_i slack_i, over
/// the objective's scale: 0 at a minimum, and about the relative gain that is
/// left elsewhere. No constraint has to be called active or not.
struct FirstOrderReport {
  double residual = 0.0;         // [1]
  double stationarity = 0.0;     // its first part
  double complementarity = 0.0;  // its second part
  double violation = 0.0;        // largest, in constraint scales
  double unit = 1.0;  // the objective's scale that the residual is over, > 0
  /// m of grad f + sum m_i grad c_i = 0 for the constraints: positive where an
  /// upper bound holds the objective up, negative where a lower one does;
  /// d minimum / d bound = -m [objective's unit / constraint's unit].
  VectorX multipliers;
  /// The same for the variables' bounds.
  VectorX bound_multipliers;
};

/// Throws InvalidInput when sizes do not fit.
FirstOrderReport first_order(const FirstOrderInput& input);

}  // namespace meniscus::optimize
