#include "fea/stress/singular_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fea/element/outer_edges.h"
#include "fea/element/stress_measures.h"

namespace meniscus::stress {

namespace {

constexpr double kPi = std::numbers::pi;
// Below it a groove's stress grows by less than a fiftieth as edges are halved,
// and curved faces that end in a smooth joint are not truer than that.
constexpr double kLeastTurn = 3.0 * kPi / 180.0;
// An edge amid one surface: sharper than facets of a curved one are.
constexpr double kSharpTurn = 40.0 * kPi / 180.0;

/// Where `f` changes its sign between `low` and `high`.
template <class Function>
double bisect(const Function& f, double low, double high) {
  const bool rises = f(high) > 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0.0) == rises ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double groove_order(double angle) {
  if (angle <= kPi) {
    return 0.0;
  }
  const auto equation = [&](double root) {
    return std::sin(root * angle) + root * std::sin(angle);
  };
  return 1.0 - bisect(equation, 0.5, 1.0);
}

double clamp_order(double angle, double poisson) {
  const double kolosov = 3.0 - 4.0 * poisson;
  const auto equation = [&](double root) {
    const double own = std::sin(root * angle);
    const double turned = root * std::sin(angle);
    return own * own -
           (4.0 * (1.0 - poisson) * (1.0 - poisson) - turned * turned) /
               kolosov;
  };
  // Where sin(root angle) is largest; beyond it roots are complex, and that is
  // near their real part.
  const double last = std::min(1.0, 0.5 * kPi / angle);
  const double root = equation(last) > 0.0 ? bisect(equation, 0.0, last) : last;
  return std::clamp(1.0 - root, 0.0, 0.5);
}

std::vector<SingularEdge> singular_edges(const TetMesh& mesh,
                                         const std::vector<char>& held,
                                         const std::vector<double>& poisson,
                                         const std::vector<char>& mirrors) {
  const auto is_mirror = [&](int face) {
    return !mirrors.empty() && mirrors[face] != 0 && held[face] == 0;
  };
  const element::FaceQuadrature at_nodes(mesh.order, element::FaceRule::Nodes);
  std::vector<SingularEdge> edges;
  for (const element::OuterEdge& outer : element::outer_edges(mesh)) {
    auto [first, second] = outer.face;
    if (held[second] != 0) {
      std::swap(first, second);
    }
    const double turn = element::turn_of(mesh, at_nodes, outer).value;
    SingularEdge edge{
        .corners = outer.corners,
        .labels = {mesh.face_label[first], mesh.face_label[second]},
        .clamped = held[first] != 0,
        .angle = kPi + turn};
    if (is_mirror(first) || is_mirror(second)) {
      edge.angle = std::min(2.0 * edge.angle, 2.0 * kPi);
      if (held[first] == 0 && is_mirror(first) != is_mirror(second) &&
          edge.angle > kPi + kSharpTurn) {
        edge.order = groove_order(edge.angle);
        edges.push_back(edge);
      }
      continue;
    }
    const bool is_sharp =
        turn > (edge.labels[0] == edge.labels[1] ? kSharpTurn : kLeastTurn);
    if (held[first] != 0 && held[second] == 0) {
      edge.order = clamp_order(
          edge.angle, poisson[mesh.element_region[mesh.face_element[first]]]);
    } else if (held[first] == 0 && is_sharp) {
      edge.order = groove_order(edge.angle);
    }
    if (edge.order > 0.0) {
      edges.push_back(edge);
    }
  }
  return edges;
}

std::optional<SingularPeak> largest_singular_peak(
    const TetMesh& mesh, const std::vector<SingularEdge>& edges,
    const RecoveredStress& stress, const Excluded& excluded, double factor) {
  // 1. The worst edge at each corner.
  std::vector<int> edge_of(static_cast<std::size_t>(mesh.corner_count), -1);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (const int corner : edges[i].corners) {
      int& worst = edge_of[static_cast<std::size_t>(corner)];
      if (worst < 0 ||
          edges[i].order > edges[static_cast<std::size_t>(worst)].order) {
        worst = static_cast<int>(i);
      }
    }
  }
  // 2. What stress there would grow to.
  std::optional<SingularPeak> largest;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (const int copy : stress.nodes.element(e)) {
      const int node = stress.nodes.node[copy];
      if (node >= mesh.corner_count || edge_of[node] < 0 ||
          !excluded.counts(e, node)) {
        continue;
      }
      const SingularEdge& edge = edges[static_cast<std::size_t>(edge_of[node])];
      const double here = element::von_mises(stress.value[copy]);
      const double grown = here * std::pow(factor, edge.order);
      if (!largest || grown > largest->grown) {
        largest = SingularPeak{edge, mesh.nodes[node], here, grown};
      }
    }
  }
  return largest;
}

}  // namespace meniscus::stress
