#include "fea/stress/averaged_stress.h"

#include <algorithm>
#include <array>

#include "fea/element/node_elements.h"
#include "fea/element/tet_element.h"

namespace meniscus::stress {

namespace {

/// Stresses at the four corners of an element: its own everywhere for four
/// nodes, linearly from the four points for ten.
std::array<element::Stress, 4> corner_stresses(
    const element::PointStress& points, int e) {
  std::array<element::Stress, 4> corner;
  const element::Stress* point = &points.stress[points.index(e)];
  if (points.points_per_element == 1) {
    corner.fill(point[0]);
    return corner;
  }
  for (int k = 0; k < 6; ++k) {
    const double sum = point[0][k] + point[1][k] + point[2][k] + point[3][k];
    for (int c = 0; c < 4; ++c) {
      corner[c][k] = (point[c][k] - element::kTetRuleLow * sum) /
                     (element::kTetRuleHigh - element::kTetRuleLow);
    }
  }
  return corner;
}

/// What corner c takes of the stress of point q.
double corner_share(const element::PointStress& points, int c, int q) {
  if (points.points_per_element == 1) {
    return 1.0;
  }
  return ((c == q ? 1.0 : 0.0) - element::kTetRuleLow) /
         (element::kTetRuleHigh - element::kTetRuleLow);
}

/// Of two corners each, the same twice for a corner.
Edge ends_of(const element::RegionNodes& nodes, int e, int copy) {
  const auto ids = nodes.element(e);
  const int a =
      static_cast<int>(std::find(ids.begin(), ids.end(), copy) - ids.begin());
  return a < 4 ? Edge{a, a} : Edge{kTetEdges[a - 4][0], kTetEdges[a - 4][1]};
}

double volume_at_points(const element::PointStress& points, int e) {
  double volume = 0.0;
  for (int q = 0; q < points.points_per_element; ++q) {
    volume += points.volume[points.index(e, q)];
  }
  return volume;
}

/// The mean of what the elements around the copy of a node say.
element::Stress mean_at(
    const element::RegionNodes& nodes, const element::PointStress& points,
    const std::vector<std::array<element::Stress, 4>>& corners,
    const element::NodeElements& around, MeanWeight by, int copy) {
  element::Stress sum{};
  double weight = 0.0;
  for (const int e : around.of(copy)) {
    const auto [a, b] = ends_of(nodes, e, copy);
    const element::Stress& from = corners[e][a];
    const element::Stress& to = corners[e][b];
    const double volume =
        by == MeanWeight::Equal ? 1.0 : volume_at_points(points, e);
    weight += volume;
    for (int k = 0; k < 6; ++k) {
      sum[k] += volume * 0.5 * (from[k] + to[k]);
    }
  }
  if (weight != 0.0) {
    for (double& s : sum) {
      s /= weight;
    }
  }
  return sum;
}

}  // namespace

RecoveredStress average_extrapolations(const TetMesh& mesh,
                                       const element::PointStress& points,
                                       MeanWeight weight) {
  const int elements = mesh.element_count();
  const int width = mesh.nodes_per_element();
  RecoveredStress result{.nodes = element::region_nodes(mesh), .value = {}};
  const int copies = result.nodes.count();
  const element::NodeElements around =
      element::node_elements(result.nodes.elements, width, width, copies);
  std::vector<std::array<element::Stress, 4>> corners(elements);
  result.value.resize(static_cast<std::size_t>(copies));
#pragma omp parallel for schedule(static)
  for (int e = 0; e < elements; ++e) {
    corners[e] = corner_stresses(points, e);
  }
#pragma omp parallel for schedule(static)
  for (int i = 0; i < copies; ++i) {
    result.value[i] = mean_at(result.nodes, points, corners, around, weight, i);
  }
  return result;
}

void transpose_averages(const RecoveredStress& averaged,
                        const element::PointStress& points,
                        const std::vector<element::Stress>& by_value,
                        element::PointCovector& by) {
  const element::RegionNodes& nodes = averaged.nodes;
  const int width = nodes.nodes_per_element;
  const element::NodeElements around =
      element::node_elements(nodes.elements, width, width, nodes.count());
  for (int i = 0; i < nodes.count(); ++i) {
    const element::Stress& g = by_value[i];
    double weight = 0.0;
    for (const int e : around.of(i)) {
      weight += volume_at_points(points, e);
    }
    if (element::is_zero(g) || weight == 0.0) {
      continue;
    }
    const double of_mean = element::dot(g, averaged.value[i]);
    for (const int e : around.of(i)) {
      const auto [a, b] = ends_of(nodes, e, i);
      const std::array<element::Stress, 4> corner = corner_stresses(points, e);
      const double here =
          0.5 * (element::dot(g, corner[a]) + element::dot(g, corner[b]));
      const double part = volume_at_points(points, e) / weight;
      for (int q = 0; q < points.points_per_element; ++q) {
        const std::size_t at = points.index(e, q);
        by.volume[at] += (here - of_mean) / weight;
        element::add_scaled(
            part * 0.5 *
                (corner_share(points, a, q) + corner_share(points, b, q)),
            g, by.stress[at]);
      }
    }
  }
}

}  // namespace meniscus::stress
