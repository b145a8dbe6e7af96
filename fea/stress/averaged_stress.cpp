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

/// The mean of what the elements around the copy of a node say.
element::Stress mean_at(
    const element::RegionNodes& nodes, const element::PointStress& points,
    const std::vector<std::array<element::Stress, 4>>& corners,
    const element::NodeElements& around, MeanWeight by, int copy) {
  element::Stress sum{};
  double weight = 0.0;
  for (const int e : around.of(copy)) {
    const auto ids = nodes.element(e);
    const int a =
        static_cast<int>(std::find(ids.begin(), ids.end(), copy) - ids.begin());
    const element::Stress& from = corners[e][a < 4 ? a : kTetEdges[a - 4][0]];
    const element::Stress& to = corners[e][a < 4 ? a : kTetEdges[a - 4][1]];
    double volume = by == MeanWeight::Equal ? 1.0 : 0.0;
    for (int q = 0; by == MeanWeight::Volume && q < points.points_per_element;
         ++q) {
      volume += points.volume[points.index(e, q)];
    }
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

}  // namespace meniscus::stress
