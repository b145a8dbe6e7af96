#include "fea/supports/supports.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/surface_faces.h"
#include "fea/element/surface_normals.h"
#include "fea/supports/pins.h"

namespace meniscus::supports {

namespace {

/// Uncertainty of a normal, in spreads of the facets' normals around its node.
constexpr double kSpreads = 2.0;

Mat3 axes_of(const loads::Support& support, const loads::LoadCase& load_case) {
  if (!loads::value_of(support.displacement).allFinite()) {
    throw InvalidInput(fmt::format(
        "load case '{}': the support on '{}' enforces a displacement that is "
        "not finite",
        load_case.name, support.surface));
  }
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
        held.push_back({.node = node,
                        .direction = axes.col(k),
                        .uncertainty = kExactDirection,
                        .component = k,
                        .value = loads::value_of(support.displacement)[k]});
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
  if (!std::isfinite(node.displacement)) {
    throw InvalidInput(fmt::format(
        "load case '{}': node {} is held at a displacement that is not a "
        "finite number",
        load_case.name, node.node));
  }
  held.push_back({.node = node.node,
                  .direction = node.direction / length,
                  .uncertainty = kExactDirection,
                  .value = node.displacement});
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

/// A pin holds its nodes by itself: what a support adds there must be met by
/// all motions that the pin has.
void require_met(const TetMesh& mesh, const loads::LoadCase& load_case,
                 std::size_t pin, const PinFrame& frame,
                 const HeldDirection& held) {
  const Vec3& x = mesh.nodes[held.node];
  double size = 0.0;
  for (const int node : frame.nodes) {
    size = std::max(size, (mesh.nodes[node] - frame.point).norm());
  }
  double along = 0.0;
  double most = std::abs(held.value);
  double loose = 0.0;
  for (int k = 0; k < 6; ++k) {
    const double part = held.direction.dot(frame.motion(k, x));
    if (frame.fixed[k]) {
      const double value = pin_value(load_case.pins[pin], k);
      along += value * part;
      most = std::max(most, std::abs(value) * (k < 3 ? 1.0 : size));
    } else {
      loose = std::max(loose, std::abs(part) / (k < 3 ? 1.0 : size));
    }
  }
  if (loose > kExactDirection ||
      std::abs(along - held.value) > kExactDirection * most) {
    throw InvalidInput(fmt::format(
        "load case '{}': the node at ({:.4g}, {:.4g}, {:.4g}) is on the rigid "
        "pin of '{}' and held by the support on '{}' otherwise than the pin "
        "moves; fix the pin along with it (fix, fix_rotation), or end one of "
        "the surfaces before the other",
        load_case.name, x.x(), x.y(), x.z(),
        load_case.pins[pin].surfaces.text(),
        load_case.supports[held.support].surface));
  }
}

void leave_to_pins(const TetMesh& mesh, const loads::LoadCase& load_case,
                   std::vector<HeldDirection>& held) {
  const std::vector<PinFrame> frames = pin_frames(mesh, load_case);
  std::vector<int> pin_of(mesh.nodes.size(), -1);
  for (std::size_t p = 0; p < frames.size(); ++p) {
    for (const int node : frames[p].nodes) {
      pin_of[node] = static_cast<int>(p);
    }
  }
  for (const HeldDirection& h : held) {
    if (pin_of[h.node] >= 0) {
      const auto pin = static_cast<std::size_t>(pin_of[h.node]);
      require_met(mesh, load_case, pin, frames[pin], h);
    }
  }
  held.erase(std::remove_if(
                 held.begin(), held.end(),
                 [&](const HeldDirection& h) { return pin_of[h.node] >= 0; }),
             held.end());
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
  if (!load_case.pins.empty()) {
    leave_to_pins(mesh, load_case, held);
  }
  return held;
}

std::array<Vec3, 3> dual_directions(const HeldDirection* first,
                                    const HeldSpan& span) {
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> D(3, span.rank);
  for (int k = 0; k < span.rank; ++k) {
    D.col(k) = first[span.index[k]].direction;
  }
  const auto inverse = (D.transpose() * D).eval().inverse().eval();
  std::array<Vec3, 3> dual;
  for (int k = 0; k < span.rank; ++k) {
    dual[k] = D * inverse.col(k);
  }
  return dual;
}

solver::NodeFreedom node_freedom(const TetMesh& mesh,
                                 std::vector<HeldDirection> held) {
  solver::NodeFreedom freedom{static_cast<int>(mesh.nodes.size()), {}, {}};
  over_held_nodes(std::move(held),
                  [&](const HeldDirection* first, const HeldDirection*,
                      const HeldSpan& span) {
                    freedom.held.push_back(first->node);
                    freedom.projector.push_back(projector_across(span));
                  });
  return freedom;
}

}  // namespace meniscus::supports
