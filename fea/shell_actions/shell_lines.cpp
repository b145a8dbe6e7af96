#include "fea/shell_actions/shell_lines.h"

#include <fmt/format.h>

#include "core/error.h"
#include "fea/shell/shell_loads.h"

namespace meniscus::shell {

namespace {

/// visit(edge, point) along the line.
template <class Visit>
void along_line(const ShellMesh& mesh, const Line& line, const Visit& visit) {
  for (const std::array<int, 3>& edge : line) {
    for (const LinePoint& p : line_points(mesh, edge)) {
      visit(edge, p);
    }
  }
}

}  // namespace

double line_length(const ShellMesh& mesh, const Line& line) {
  double length = 0.0;
  along_line(mesh, line, [&](const auto&, const LinePoint& p) {
    length += p.weight * p.tangent.norm();
  });
  return length;
}

LineMean mean_displacement(const ShellMesh& mesh, const Line& line,
                           const Vec3& direction, const VectorX& displacement) {
  const double length = line_length(mesh, line);
  const double given = direction.norm();
  if (!(length > 0.0) || !(given > 0.0)) {
    throw InvalidInput(
        fmt::format("a mean displacement is asked along ({}, {}, {}) of a line "
                    "of length {}",
                    direction.x(), direction.y(), direction.z(), length));
  }
  const Vec3 d = direction / given;
  const auto at = [&](const std::array<int, 3>& edge, const LinePoint& p) {
    Vec3 u = Vec3::Zero();
    for (std::size_t k = 0; k < edge.size(); ++k) {
      u += p.shape[k] * displacement.segment<3>(6L * edge[k]);
    }
    return u;
  };
  LineMean mean;
  mean.by_nodes.assign(mesh.nodes.size(), Vec3::Zero());
  mean.by_displacement = VectorX::Zero(displacement.size());
  Vec3 by_unit = Vec3::Zero();
  along_line(mesh, line, [&](const auto& edge, const LinePoint& p) {
    by_unit += p.weight * p.tangent.norm() / length * at(edge, p);
  });
  mean.value = by_unit.dot(d);
  along_line(mesh, line, [&](const auto& edge, const LinePoint& p) {
    const double excess = at(edge, p).dot(d) - mean.value;
    for (std::size_t k = 0; k < edge.size(); ++k) {
      mean.by_displacement.template segment<3>(6L * edge[k]) +=
          p.weight * p.tangent.norm() / length * p.shape[k] * d;
      mean.by_nodes[edge[k]] +=
          excess / length * p.weight * p.slope[k] * p.tangent.normalized();
    }
  });
  mean.by_direction = (by_unit - mean.value * d) / given;
  return mean;
}

}  // namespace meniscus::shell
