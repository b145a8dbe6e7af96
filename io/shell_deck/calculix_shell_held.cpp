#include "io/shell_deck/calculix_shell_held.h"

#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::shell_deck {

namespace {

constexpr double kSameDirection = 1e-9;  // of rounding
// Sine below which a direction counts as normal to the wall, or in it: mean
// normals of facets are off by less.
constexpr double kAlong = 0.1;

/// Directions at right angles that span what was added.
class Span {
 public:
  void add(Vec3 direction) {
    for (const Vec3& known : axes_) {
      direction -= known.dot(direction) * known;
    }
    if (direction.norm() > kAlong) {
      axes_.push_back(direction.normalized());
    }
  }
  std::size_t size() const { return axes_.size(); }
  const Vec3& only() const { return axes_.front(); }
  /// Of two: the direction across both.
  Vec3 across() const { return axes_[0].cross(axes_[1]); }
  bool partial() const { return size() == 1 || size() == 2; }
  /// The direction that tells a partial span: its own, or that left out.
  Vec3 direction() const { return size() == 1 ? only() : across(); }

 private:
  std::vector<Vec3> axes_;
};

struct NodeSpans {
  Span displacements;
  Span rotations;
};

std::map<int, NodeSpans> spans_of(const DeckShellStep& step) {
  std::map<int, NodeSpans> spans;
  for (const DeckShellSupport& support : step.supports) {
    const Mat3 axes = support.axes.value_or(Mat3::Identity());
    for (const int node : support.nodes) {
      NodeSpans& own = spans[node];
      for (int c = 0; c < 6; ++c) {
        if (support.fixed[static_cast<std::size_t>(c)]) {
          (c < 3 ? own.displacements : own.rotations).add(axes.col(c % 3));
        }
      }
    }
  }
  return spans;
}

/// Rotations about tangents: none, about one, or about both.
struct HeldTurns {
  int count = 0;
  Vec3 about = Vec3::Zero();  // of one
};

HeldTurns held_turns(const Span& rotations, const Vec3& normal) {
  if (rotations.size() == 1) {
    const Vec3& r = rotations.only();
    const Vec3 tangent = r - r.dot(normal) * normal;
    return std::abs(r.dot(normal)) < kAlong ? HeldTurns{1, tangent.normalized()}
                                            : HeldTurns{};
  }
  const Vec3 tangent = normal.cross(rotations.across());
  return tangent.norm() < kAlong ? HeldTurns{2, Vec3::Zero()}
                                 : HeldTurns{1, tangent.normalized()};
}

/// The frame with its nearest column made `direction`, and which that is.
Mat3 turned_to(const Mat3& frame, const Vec3& direction, int& column) {
  Eigen::Index nearest = 0;
  (frame.transpose() * direction).cwiseAbs().maxCoeff(&nearest);
  column = static_cast<int>(nearest);
  const int next = (column + 1) % 3;
  const int last = (column + 2) % 3;
  Mat3 turned;
  turned.col(column) =
      frame.col(column).dot(direction) > 0.0 ? direction : Vec3(-direction);
  turned.col(last) = turned.col(column).cross(frame.col(next)).normalized();
  turned.col(next) = turned.col(last).cross(turned.col(column));
  return turned;
}

/// False where displacements are held aslant to the wall's frame.
bool hold(const NodeSpans& spans, const Vec3& normal, HeldShellNode& held) {
  Mat3 frame = Mat3::Identity();
  HeldTurns turns;
  if (spans.rotations.partial()) {
    turns = held_turns(spans.rotations, normal);
    if (turns.count > 0) {
      const Vec3 any = spans.displacements.partial()
                           ? spans.displacements.direction()
                           : normal.unitOrthogonal();
      const bool is_normal = any.cross(normal).norm() < kAlong;
      frame = wall_frame(turns.count == 1 ? turns.about
                         : is_normal      ? normal.unitOrthogonal()
                                          : any,
                         normal);
      held.fixed[3] = true;
      held.fixed[4] = turns.count == 2;
    }
  }
  held.fixed[3] = held.fixed[3] || spans.rotations.size() == 3;
  held.fixed[4] = held.fixed[4] || spans.rotations.size() == 3;
  held.fixed[5] = spans.rotations.size() == 3;
  for (std::size_t c = 0; c < 3; ++c) {
    held.fixed[c] = spans.displacements.size() == 3;
  }
  if (spans.displacements.partial()) {
    const Vec3 direction = spans.displacements.direction();
    int column = 0;
    const Mat3 turned = turned_to(frame, direction, column);
    if (turns.count > 0 &&
        std::abs(frame.col(column).dot(direction)) < 1.0 - kAlong) {
      return false;
    }
    frame = turned;
    for (int c = 0; c < 3; ++c) {
      held.fixed[static_cast<std::size_t>(c)] =
          (c == column) == (spans.displacements.size() == 1);
    }
  }
  if ((frame.cwiseAbs() - Mat3::Identity()).norm() > kSameDirection) {
    held.frame = frame;
  }
  return true;
}

}  // namespace

Mat3 wall_frame(const Vec3& first, const Vec3& normal) {
  Mat3 frame;
  frame.col(2) = normal;
  frame.col(0) = (first - first.dot(normal) * normal).normalized();
  frame.col(1) = normal.cross(frame.col(0));
  return frame;
}

std::vector<std::map<int, HeldShellNode>> held_shell_nodes(
    const ShellDeck& deck, const Points& normals) {
  std::vector<std::map<int, HeldShellNode>> steps;
  std::map<int, std::optional<Mat3>> frames;
  for (const DeckShellStep& step : deck.steps) {
    auto& nodes = steps.emplace_back();
    for (const auto& [node, spans] : spans_of(step)) {
      HeldShellNode held;
      if (!hold(spans, normals[static_cast<std::size_t>(node)], held)) {
        const Vec3& at = deck.nodes[static_cast<std::size_t>(node)];
        throw InvalidInput(fmt::format(
            "load case '{}' holds node {} at ({:.4g}, {:.4g}, {:.4g}) along a "
            "direction aslant to the shell there, and its rotations in part: "
            "CalculiX cannot have both; hold all rotations or none, or export "
            "bdf",
            step.name, node + 1, at.x(), at.y(), at.z()));
      }
      if (needs_axes(held.fixed)) {
        const auto known = frames.emplace(node, held.frame).first;
        if (known->second != held.frame) {
          throw InvalidInput(fmt::format(
              "load case '{}' holds node {} along other axes than another load "
              "case does; a deck has one frame a node: export a case with one "
              "of them",
              step.name, node + 1));
        }
      } else {
        held.frame.reset();
      }
      nodes.emplace(node, held);
    }
  }
  return steps;
}

}  // namespace meniscus::shell_deck
