/// Symmetric sparse matrices with one number per pair of nodes, which acts
/// alike on x, y and z: mass and geometric stiffness. They share the pattern of
/// the stiffness matrix and take a ninth of its memory.
#pragma once

#include <vector>

#include "fea/element/point_stress.h"
#include "fea/solver/assembly.h"

namespace meniscus::solver {

/// Values of the matrix's blocks, each a multiple of the unit matrix.
struct NodalMatrix {
  std::vector<double> diagonal;  // one per node
  std::vector<double> lower;     // one per column of the pattern
};

/// y = A x for K vectors of padded layout (see block_matrix.h), K from 1 to 4.
/// The padding of x must be zero, that of y becomes zero.
template <int K>
void multiply(const BlockPattern& pattern, const NodalMatrix& matrix,
              const double* x, double* y);

/// Adds factor x A to `matrix` of the same pattern.
void add_scaled(double factor, const NodalMatrix& A,
                BlockMatrix<double>& matrix);

/// Where the mass is integrated.
enum class MassRule {
  Exact,           // for four nodes and straight ten-node elements; the rule of
                   // degree five on curved ones
  StiffnessPoints  // as CalculiX 2.20 does: one point, or four
};

/// Consistent mass: M_ab = int rho N_a N_b dV [mass]. `density`: one per region
/// [mass/length^3]; `x`: the solver's nodes.
NodalMatrix mass_matrix(const ElementTable& table, const Points& x,
                        const std::vector<double>& density,
                        MassRule rule = MassRule::Exact);

/// Geometric stiffness of the stress state: x^T K_g x = int sigma : (grad u^T
/// grad u) dV, by the stiffness rule at whose points the stresses stand
/// [force/length]. `element`: the table's element -> that of `stress`. Dead
/// loads: that pressures turn with the surface is left out.
NodalMatrix geometric_stiffness(const ElementTable& table, const Points& x,
                                const std::vector<int>& element,
                                const element::PointStress& stress);

}  // namespace meniscus::solver
