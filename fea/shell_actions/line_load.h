/// A force and a moment carried by the edges of a shell's facets together: what
/// fea/loads/remote_load.h is to surfaces.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fea/shell/shell_gradient.h"
#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

/// Without stiffening the edges. With d from their centre, by length, and b the
/// turn of a rigid line: the force per length is F / length + b x d, linear in
/// the place, and a moment of t^2 / 12 (b . e) per length acts about the edge's
/// direction e, as on the end of a wall of thickness t. Of all such sets with
/// the given force and moment the least in |force|^2 + 12 / t^2 moment^2, by
/// length. A straight line has b . e alone about itself.
struct LineLoad {
  std::vector<FacetEdge> edges;  // each once
  std::optional<Vec3> point;     // where the force acts; else their centre
  Vec3 force = Vec3::Zero();     // [force]
  Vec3 moment = Vec3::Zero();    // beside the force's own [force length]
  std::string name;              // of the line, for messages
};

/// 6 per node: force, moment. Throws InvalidInput, naming the line, for one
/// without edges or length.
VectorX line_forces(const ShellMesh& mesh, const LineLoad& load);

/// The derivatives of v . f, f the line_forces() and v (6 per node) held.
struct LineGradient {
  double value = 0.0;
  Vec3 by_point = Vec3::Zero();
  Vec3 by_force = Vec3::Zero();
  Vec3 by_moment = Vec3::Zero();  // the line's rigid rotation under v
};

/// `gradient`: those by nodes and thicknesses are added to it, if it is not
/// null. Throws as line_forces().
LineGradient line_gradient(const ShellMesh& mesh, const LineLoad& load,
                           const VectorX& v, ShellGradient* gradient);

}  // namespace meniscus::shell
