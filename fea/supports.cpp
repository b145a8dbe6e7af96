#include "fea/supports.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/surface_faces.h"
#include "fea/surface_normals.h"

namespace meniscus {

namespace {

/// Uncertainty of a normal, in spreads of the facets' normals around its node.
constexpr double kSpreads = 2.0;

Mat3 axes_of(const Support& support, const LoadCase& load_case) {
  if (!support.axes) {
    return Mat3::Identity();
  }
  if (!span_a_plane(*support.axes)) {
    throw InvalidInput(fmt::format(
        "load case '{}': the axes of the support on '{}' have no length or are "
        "parallel; give two that span a plane",
        load_case.name, support.surface));
  }
  return unit_axes(*support.axes);
}

void add_components(const TetMesh& mesh, const Support& support,
                    const LoadCase& load_case,
                    std::vector<HeldDirection>& held) {
  const Mat3 axes = axes_of(support, load_case);
  const std::array<bool, 3> fix = {support.fix_x, support.fix_y, support.fix_z};
  const int label = surface_label(mesh, support.surface);
  for (const int node : surface_nodes(mesh, label)) {
    for (int k = 0; k < 3; ++k) {
      if (fix[k]) {
        held.push_back({node, axes.col(k), kExactDirection});
      }
    }
  }
}

void add_normals(const TetMesh& mesh, const Support& support,
                 std::vector<HeldDirection>& held) {
  if (support.kind == SupportKind::Symmetry) {
    const Vec3 normal = plane_normal(mesh, support.surface);
    const int label = surface_label(mesh, support.surface);
    for (const int node : surface_nodes(mesh, label)) {
      held.push_back({node, normal, kExactDirection});
    }
    return;
  }
  const SurfaceNormals normals = surface_normals(mesh, support.surface);
  for (std::size_t k = 0; k < normals.nodes.size(); ++k) {
    held.push_back({normals.nodes[k], normals.normal[k],
                    std::max(kExactDirection, kSpreads * normals.spread[k])});
  }
}

/// Onto what is across the directions [first, last), taken in their order.
Mat3 projector_across(const HeldDirection* first, const HeldDirection* last) {
  std::array<Vec3, 3> span;
  int rank = 0;
  double least = 0.0;
  for (; first != last && rank < 3; ++first) {
    least = std::max(least, first->uncertainty);
    Vec3 rest = first->direction;
    for (int k = 0; k < rank; ++k) {
      rest -= span[k].dot(rest) * span[k];
    }
    if (rest.norm() > least) {
      span[rank++] = rest.normalized();
    }
  }
  if (rank == 3) {
    return Mat3::Zero();
  }
  Mat3 projector = Mat3::Identity();
  for (int k = 0; k < rank; ++k) {
    projector -= span[k] * span[k].transpose();
  }
  return projector;
}

}  // namespace

std::vector<HeldDirection> held_directions(const TetMesh& mesh,
                                           const LoadCase& load_case) {
  std::vector<HeldDirection> held;
  for (const Support& support : load_case.supports) {
    if (support.kind == SupportKind::Components) {
      add_components(mesh, support, load_case, held);
    }
  }
  for (const Support& support : load_case.supports) {
    if (support.kind != SupportKind::Components) {
      add_normals(mesh, support, held);
    }
  }
  return held;
}

NodeFreedom node_freedom(const TetMesh& mesh, std::vector<HeldDirection> held) {
  std::stable_sort(held.begin(), held.end(),
                   [](const HeldDirection& a, const HeldDirection& b) {
                     return a.node < b.node;
                   });
  NodeFreedom freedom{static_cast<int>(mesh.nodes.size()), {}, {}};
  for (std::size_t k = 0; k < held.size();) {
    std::size_t end = k;
    while (end < held.size() && held[end].node == held[k].node) {
      ++end;
    }
    freedom.held.push_back(held[k].node);
    freedom.projector.push_back(
        projector_across(held.data() + k, held.data() + end));
    k = end;
  }
  return freedom;
}

}  // namespace meniscus
