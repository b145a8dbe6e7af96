#include "fea/supports/enforced.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "fea/loads/support.h"
#include "fea/supports/pins.h"
#include "fea/supports/springs.h"
#include "fea/supports/supports.h"

namespace meniscus::supports {

namespace {

Vec3 node_value(const VectorX& v, int node) { return v.segment<3>(3L * node); }

/// Directions of a node that do not count must agree with those that do.
void require_agreement(const TetMesh& mesh, const loads::LoadCase& load_case,
                       const HeldDirection& held, const Vec3& u,
                       double uncertainty) {
  constexpr double kRoom = 2.0;  // the turn of a normal, both ways
  const double gap = std::abs(held.direction.dot(u) - held.value);
  if (gap > kRoom * uncertainty * (u.norm() + std::abs(held.value))) {
    const Vec3& x = mesh.nodes[held.node];
    throw InvalidInput(fmt::format(
        "load case '{}': {} enforces a displacement of {:.4g} "
        "at ({:.4g}, {:.4g}, {:.4g}), where another support has {:.4g}; leave "
        "the place free of one of them",
        load_case.name,
        held.support < 0
            ? "a held node"
            : fmt::format("the support on '{}'",
                          load_case.supports[held.support].surface),
        held.value, x.x(), x.y(), x.z(), held.direction.dot(u)));
  }
}

/// Reactions of what holds, springs left out: r to the displacement and r' to
/// the adjoint.
struct HeldReactions {
  VectorX primal;
  VectorX adjoint;

  HeldReactions(const TetMesh& mesh, const loads::LoadCase& load_case,
                const loads::AdjointPair& pair) {
    const SpringBlocks springs = spring_blocks(mesh, load_case, mesh.order);
    primal = reactions_of_supports(pair.reactions, springs, pair.displacement);
    adjoint =
        reactions_of_supports(pair.adjoint_reactions, springs, pair.lambda);
  }
};

/// By the numbers of one pin: -r' . du and -r . dlambda, the motions' own.
void add_pin_numbers(const TetMesh& mesh, const PinFrame& frame,
                     const HeldReactions& reactions,
                     const loads::AdjointPair& pair, loads::RigidPin& by) {
  const Vec3 turn = motion_of(frame, mesh.nodes, pair.displacement).rotation;
  const Vec3 adjoint_turn = motion_of(frame, mesh.nodes, pair.lambda).rotation;
  Vec3 displacement = loads::value_of(by.displacement);
  Vec3 rotation = loads::value_of(by.rotation);
  for (const int node : frame.nodes) {
    const Vec3 r = node_value(reactions.primal, node);
    const Vec3 adjoint_r = node_value(reactions.adjoint, node);
    by.point += adjoint_r.cross(turn) + r.cross(adjoint_turn);
    for (int k = 0; k < 3; ++k) {
      const Vec3& x = mesh.nodes[node];
      displacement[k] -=
          frame.fixed[k] ? adjoint_r.dot(frame.motion(k, x)) : 0.0;
      rotation[k] -=
          frame.fixed[k + 3] ? adjoint_r.dot(frame.motion(k + 3, x)) : 0.0;
    }
  }
  by.displacement = displacement;
  by.rotation = rotation;
}

}  // namespace

VectorX enforced_displacement(const TetMesh& mesh,
                              const loads::LoadCase& load_case) {
  if (!loads::enforces(load_case)) {
    return {};
  }
  VectorX u = VectorX::Zero(static_cast<Eigen::Index>(3 * mesh.nodes.size()));
  over_held_nodes(
      held_directions(mesh, load_case),
      [&](const HeldDirection* first, const HeldDirection* last,
          const HeldSpan& span) {
        const std::array<Vec3, 3> dual = dual_directions(first, span);
        Vec3 here = Vec3::Zero();
        for (int k = 0; k < span.rank; ++k) {
          here += first[span.index[k]].value * dual[k];
        }
        double uncertainty = 0.0;
        for (const HeldDirection* held = first; held != last; ++held) {
          uncertainty = std::max(uncertainty, held->uncertainty);
          require_agreement(mesh, load_case, *held, here, uncertainty);
        }
        u.segment<3>(3L * first->node) = here;
      });
  const std::vector<PinFrame> frames = pin_frames(mesh, load_case);
  for (std::size_t p = 0; p < frames.size(); ++p) {
    for (const int node : frames[p].nodes) {
      for (int k = 0; k < 6; ++k) {
        if (frames[p].fixed[k]) {
          u.segment<3>(3L * node) += pin_value(load_case.pins[p], k) *
                                     frames[p].motion(k, mesh.nodes[node]);
        }
      }
    }
  }
  return u.isZero(0.0) ? VectorX() : u;
}

void add_enforced_gradient(const TetMesh& mesh,
                           const loads::LoadCase& load_case,
                           const loads::AdjointPair& pair,
                           loads::LoadCase& by_number) {
  by_number.supports.resize(load_case.supports.size());
  by_number.pins.resize(load_case.pins.size());
  const bool numbers =
      loads::enforces(load_case) ||
      std::any_of(load_case.pins.begin(), load_case.pins.end(),
                  [](const loads::RigidPin& pin) { return pin.holds(); });
  if (!numbers) {
    return;
  }
  const HeldReactions reactions(mesh, load_case, pair);
  over_held_nodes(
      held_directions(mesh, load_case),
      [&](const HeldDirection* first, const HeldDirection*,
          const HeldSpan& span) {
        const std::array<Vec3, 3> dual = dual_directions(first, span);
        for (int k = 0; k < span.rank; ++k) {
          const HeldDirection& held = first[span.index[k]];
          auto& by = by_number.supports[held.support].displacement;
          if (held.component >= 0) {
            by = loads::value_of(by);
            (*by)[held.component] -=
                dual[k].dot(node_value(reactions.adjoint, held.node));
          }
        }
      });
  const std::vector<PinFrame> frames = pin_frames(mesh, load_case);
  for (std::size_t p = 0; p < frames.size(); ++p) {
    if (!frames[p].is_free()) {
      add_pin_numbers(mesh, frames[p], reactions, pair, by_number.pins[p]);
    }
  }
}

void add_pin_gradient(const TetMesh& mesh, const loads::LoadCase& load_case,
                      const loads::AdjointPair& pair, Points& gradient) {
  if (load_case.pins.empty()) {
    return;
  }
  const HeldReactions reactions(mesh, load_case, pair);
  for (const PinFrame& frame : pin_frames(mesh, load_case)) {
    const Vec3 turn = motion_of(frame, mesh.nodes, pair.displacement).rotation;
    const Vec3 adjoint_turn =
        motion_of(frame, mesh.nodes, pair.lambda).rotation;
    for (const int node : frame.nodes) {
      gradient[node] -= node_value(reactions.adjoint, node).cross(turn) +
                        node_value(reactions.primal, node).cross(adjoint_turn);
    }
  }
}

}  // namespace meniscus::supports
