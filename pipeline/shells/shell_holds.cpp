#include "pipeline/shells/shell_holds.h"

#include <array>
#include <set>
#include <string>
#include <utility>

#include "core/geometry/surface_mesh.h"

namespace meniscus::shells {

namespace {

/// Of those that are corners. By their frozen places, so that a design does not
/// choose another.
int nearest(const Points& corners, const std::set<int>& nodes, const Vec3& at) {
  int best = *nodes.begin();
  for (const int node : nodes) {
    if (node < std::ssize(corners) &&
        (corners[node] - at).norm() < (corners[best] - at).norm()) {
      best = node;
    }
  }
  return best;
}

std::set<int> nodes_on(const ShellPart& part, const std::string& surface) {
  std::set<int> nodes;
  if (part.rims.contains(surface) || is_rim(surface)) {
    for (const std::array<int, 3>& edge : rim_of(part, surface)) {
      nodes.insert(edge.begin(), edge.end());
    }
    return nodes;
  }
  const int label = part.skin.label_of(film_of(surface));
  for (int f = 0; f < part.skin.face_count(); ++f) {
    if (part.skin.face_label[f] == label) {
      nodes.insert(part.skin.face(f).begin(), part.skin.face(f).end());
    }
  }
  return nodes;
}

/// An image in the plane moves and turns like the node: along the plane, about
/// its normal. Planes across x, y or z have no axes of their own, so that rims
/// may end in them.
shell::NodeSupport in_plane(const Vec3& normal) {
  shell::NodeSupport support;
  Eigen::Index across = 0;
  if (normal.cwiseAbs().maxCoeff(&across) < 1.0) {
    across = 0;
    support.axes = element::LocalAxes{normal, normal.unitOrthogonal()};
  }
  for (int k = 0; k < 3; ++k) {
    support.held[k] = k == across;
    support.held[3 + k] = k != across;
  }
  return support;
}

}  // namespace

std::vector<shell::NodeSupport> node_supports(
    const ShellPart& part, const loads::LoadCase& load_case) {
  std::vector<shell::NodeSupport> supports;
  for (const loads::Support& support : load_case.supports) {
    std::set<int> nodes = nodes_on(part, support.surface);
    if (support.at) {
      nodes = {nearest(part.frozen, nodes, *support.at)};
    }
    const auto& turn = support.fix_rotation;
    shell::NodeSupport held = {
        .held = {support.fix_x, support.fix_y, support.fix_z, turn[0], turn[1],
                 turn[2]},
        .axes = support.axes};
    held.value << loads::value_of(support.displacement),
        loads::value_of(support.rotation);
    if (support.kind == loads::SupportKind::Symmetry) {
      held = in_plane(part.planes.at(support.surface));
    }
    for (const int node : nodes) {
      held.node = node;
      supports.push_back(held);
    }
  }
  return supports;
}

std::vector<shell::RigidRim> rigid_rims(const ShellPart& part,
                                        const loads::LoadCase& load_case) {
  std::vector<shell::RigidRim> rims;
  for (const loads::RigidPin& pin : load_case.pins) {
    std::set<int> nodes;
    for (const std::string& surface : pin.surfaces) {
      nodes.merge(nodes_on(part, surface));
    }
    shell::RigidRim rim{
        .name = pin.surfaces.text(),
        .nodes = {nodes.begin(), nodes.end()},
        .point = pin.point,
        .held = {pin.fix[0], pin.fix[1], pin.fix[2], pin.fix_rotation[0],
                 pin.fix_rotation[1], pin.fix_rotation[2]},
        .axes = pin.axes};
    rim.value << loads::value_of(pin.displacement),
        loads::value_of(pin.rotation);
    for (const int node : nodes) {
      rim.places.push_back(part.mesh.nodes[node]);
    }
    if (!pin.holds()) {  // any will do; near ones leave least to rounding
      rim.point = mean_of(rim.places);
    }
    rims.push_back(std::move(rim));
  }
  return rims;
}

std::vector<shell::NodeSupport> off_rims(
    std::vector<shell::NodeSupport> supports,
    const shell::ShellFreedom& freedom) {
  std::erase_if(supports, [&](const shell::NodeSupport& support) {
    return freedom.seat(support.node) != support.node;
  });
  return supports;
}

std::vector<shell::GroundSpring> ground_springs(
    const ShellPart& part, const loads::LoadCase& load_case) {
  const supports::SpringBlocks blocks = spring_blocks(part, load_case);
  std::vector<shell::GroundSpring> springs;
  springs.reserve(blocks.at.size());
  for (std::size_t k = 0; k < blocks.at.size(); ++k) {
    springs.push_back({blocks.at[k][0], blocks.at[k][1], blocks.block[k]});
  }
  return springs;
}

namespace {

/// What nodes are held at, 6 each; on rims by these alone.
VectorX held_at(const ShellPart& part, const loads::LoadCase& load_case) {
  const auto nodes = static_cast<int>(part.mesh.nodes.size());
  const shell::ShellFreedom of_rims(nodes, {}, rigid_rims(part, load_case));
  return shell::ShellFreedom(nodes,
                             off_rims(node_supports(part, load_case), of_rims),
                             of_rims.rims())
      .held_values();
}

}  // namespace

double held_rate(const ShellPart& part, const loads::LoadCase& load_case,
                 const loads::LoadCase& rates, const shell::RimPair& by) {
  double rate = 0.0;
  if (loads::enforces(load_case)) {
    loads::LoadCase moved{.name = load_case.name};
    moved.supports = load_case.supports;
    moved.pins = load_case.pins;
    for (std::size_t k = 0; k < moved.supports.size(); ++k) {
      moved.supports[k].displacement = rates.supports[k].displacement;
      moved.supports[k].rotation = rates.supports[k].rotation;
    }
    for (std::size_t k = 0; k < moved.pins.size(); ++k) {
      moved.pins[k].displacement = rates.pins[k].displacement;
      moved.pins[k].rotation = rates.pins[k].rotation;
    }
    rate -= by.adjoint_residual.dot(held_at(part, moved));
  }
  const std::vector<shell::RigidRim> rims = rigid_rims(part, load_case);
  for (std::size_t k = 0; k < rims.size(); ++k) {
    if (load_case.pins[k].holds() && !rates.pins[k].point.isZero(0.0)) {
      rate += shell::by_rim_point(rims[k], by).dot(rates.pins[k].point);
    }
  }
  return rate;
}

}  // namespace meniscus::shells
