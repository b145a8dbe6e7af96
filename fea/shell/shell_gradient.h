/// How loads and stiffness of a shell change with its nodes and thicknesses:
/// the part of an adjoint gradient that belongs to the state equation.
#pragma once

#include <vector>

#include "fea/shell/shell_loads.h"
#include "fea/shell/shell_mesh.h"
#include "fea/shell/wall_state.h"

namespace meniscus::shell {

struct ShellGradient {
  double value = 0.0;              // v . (f - K u)
  Points by_nodes;                 // one per node [of value / length]
  std::vector<Vec3> by_thickness;  // at each facet's corners [the same]
  PlyGradients by_ply;
  ActionGradient by_actions;
};

/// v . (f(x, t) - K(x, t) u) and its derivatives, f the nodal_forces() of the
/// loads, u and v (6 per node) held: with v the adjoint, all of dJ/dx but what
/// the functional J itself says. For compliance, f . u, with loads that do not
/// change, v = u. Exact, by a tape over each facet (core/math/taped.h); the
/// same bits for any number of threads. Throws as ShellSystem and
/// nodal_forces() do, and InvalidInput for vectors of another length.
/// `on_bubbles`: forces on each facet's bubble of v, as of a functional that
/// looks at the bubbles of u; null: none.
ShellGradient residual_gradient(
    const ShellMesh& mesh, const std::vector<Section>& sections,
    const ShellLoads& loads, const VectorX& v, const VectorX& u,
    const std::vector<Eigen::Vector2d>* on_bubbles = nullptr);

/// What a value changes by as its temperatures, pressures, gravity and force
/// per mass do at `rates`, of which nothing else is read; a spin's are a
/// mass_force there. Throws as nodal_forces().
double action_rate(const ShellMesh& mesh, const ActionGradient& by,
                   const ShellLoads& rates);

}  // namespace meniscus::shell
