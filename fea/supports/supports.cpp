#include "fea/supports/supports.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/surface_faces.h"
#include "fea/element/surface_normals.h"

namespace meniscus::supports {

namespace {

/// Uncertainty of a normal, in spreads of the facets' normals around its node.
constexpr double kSpreads = 2.0;

Mat3 axes_of(const loads::Support& support, const loads::LoadCase& load_case) {
  if (!support.axes) {
    return Mat3::Identity();
  }
  if (!element::span_a_plane(*support.axes)) {
    throw InvalidInput(fmt::format(
        "load case '{}': the axes of the support on '{}' have no length or are "
        "parallel; give two that span a plane",
        load_case.name, support.surface));
  }
  return element::unit_axes(*support.axes);
}

void add_components(const TetMesh& mesh, const loads::Support& support,
                    const loads::LoadCase& load_case,
                    std::vector<HeldDirection>& held) {
  const Mat3 axes = axes_of(support, load_case);
  const std::array<bool, 3> fix = {support.fix_x, support.fix_y, support.fix_z};
  const int label = element::surface_label(mesh, support.surface);
  for (const int node : element::surface_nodes(mesh, label)) {
    for (int k = 0; k < 3; ++k) {
      if (fix[k]) {
        held.push_back({node, axes.col(k), kExactDirection});
      }
    }
  }
}

void hold_node(const TetMesh& mesh, const loads::HeldNode& node,
               const loads::LoadCase& load_case,
               std::vector<HeldDirection>& held) {
  const double length = node.direction.norm();
  if (node.node < 0 || node.node >= static_cast<int>(mesh.nodes.size()) ||
      !(length > 0.0) || !std::isfinite(length)) {
    throw InvalidInput(fmt::format(
        "load case '{}': node {} of {} is held along ({}, {}, {}); give a node "
        "of the mesh and a direction with a length",
        load_case.name, node.node, mesh.nodes.size(), node.direction.x(),
        node.direction.y(), node.direction.z()));
  }
  held.push_back({node.node, node.direction / length, kExactDirection});
}

void add_normals(const TetMesh& mesh, const loads::Support& support,
                 std::vector<HeldDirection>& held) {
  if (support.kind == loads::SupportKind::Symmetry) {
    const Vec3 normal = element::plane_normal(mesh, support.surface);
    const int label = element::surface_label(mesh, support.surface);
    for (const int node : element::surface_nodes(mesh, label)) {
      held.push_back({node, normal, kExactDirection});
    }
    return;
  }
  const element::SurfaceNormals normals =
      element::surface_normals(mesh, support.surface);
  for (std::size_t k = 0; k < normals.nodes.size(); ++k) {
    held.push_back({normals.nodes[k], normals.normal[k],
                    std::max(kExactDirection, kSpreads * normals.spread[k])});
  }
}

/// Onto what is across the directions.
Mat3 projector_across(const HeldSpan& span) {
  if (span.rank == 3) {
    return Mat3::Zero();
  }
  Mat3 projector = Mat3::Identity();
  for (int k = 0; k < span.rank; ++k) {
    projector -= span.unit[k] * span.unit[k].transpose();
  }
  return projector;
}

}  // namespace

HeldSpan held_span(const HeldDirection* first, const HeldDirection* last) {
  HeldSpan span;
  double least = 0.0;
  for (const HeldDirection* at = first; at != last && span.rank < 3; ++at) {
    least = std::max(least, at->uncertainty);
    Vec3 rest = at->direction;
    for (int k = 0; k < span.rank; ++k) {
      rest -= span.unit[k].dot(rest) * span.unit[k];
    }
    if (rest.norm() > least) {
      span.index[span.rank] = static_cast<int>(at - first);
      span.unit[span.rank++] = rest.normalized();
    }
  }
  return span;
}

std::vector<HeldDirection> held_directions(const TetMesh& mesh,
                                           const loads::LoadCase& load_case) {
  std::vector<HeldDirection> held;
  const auto add = [&](bool components) {
    for (std::size_t s = 0; s < load_case.supports.size(); ++s) {
      const loads::Support& support = load_case.supports[s];
      const std::size_t first = held.size();
      if ((support.kind == loads::SupportKind::Components) != components) {
        continue;
      }
      if (components) {
        add_components(mesh, support, load_case, held);
      } else {
        add_normals(mesh, support, held);
      }
      for (std::size_t k = first; k < held.size(); ++k) {
        held[k].support = static_cast<int>(s);
      }
    }
  };
  add(true);
  for (const loads::HeldNode& node : load_case.held_nodes) {
    hold_node(mesh, node, load_case, held);
  }
  add(false);
  return held;
}

solver::NodeFreedom node_freedom(const TetMesh& mesh,
                                 std::vector<HeldDirection> held) {
  std::stable_sort(held.begin(), held.end(),
                   [](const HeldDirection& a, const HeldDirection& b) {
                     return a.node < b.node;
                   });
  solver::NodeFreedom freedom{static_cast<int>(mesh.nodes.size()), {}, {}};
  for (std::size_t k = 0; k < held.size();) {
    std::size_t end = k;
    while (end < held.size() && held[end].node == held[k].node) {
      ++end;
    }
    freedom.held.push_back(held[k].node);
    freedom.projector.push_back(
        projector_across(held_span(held.data() + k, held.data() + end)));
    k = end;
  }
  return freedom;
}

}  // namespace meniscus::supports
