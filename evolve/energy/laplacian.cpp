#include "evolve/energy/laplacian.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace meniscus::energy {

namespace {

constexpr double kClamp = 1e-3;  // x mean weight

double half_cotangent(const Vec3& apex, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - apex;
  const Vec3 v = b - apex;
  const double area2 = u.cross(v).norm();
  return area2 > 0.0 ? 0.5 * u.dot(v) / area2 : 0.0;
}

}  // namespace

LaplaceSystem cotan_laplacian(const SurfaceMesh& mesh,
                              const std::vector<double>& facet_weight,
                              const std::vector<int>& unknown_of, int unknowns,
                              CotanWeights weights) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  // Edge weights (cot alpha + cot beta) / 2 of the opposite angles: the
  // Dirichlet energy of linear functions (Pinkall, Polthier 1993).
  std::vector<double> weight(edges.size(), 0.0);
  std::vector<char> used(edges.size(), 0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (facet_weight[f] == 0.0) {
      continue;
    }
    const Triangle& t = mesh.facets[f];
    for (int k = 0; k < 3; ++k) {
      const int edge = facet_edges[f][k];
      weight[edge] +=
          facet_weight[f] * half_cotangent(mesh.points[t[(k + 2) % 3]],
                                           mesh.points[t[k]],
                                           mesh.points[t[(k + 1) % 3]]);
      used[edge] = 1;
    }
  }
  // Obtuse facets give weights below 0. Held above a small share of the mean,
  // the extension keeps to the maximum principle.
  if (weights == CotanWeights::Clamped) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      sum += std::abs(weight[e]);
      count += used[e];
    }
    const double least = count > 0.0 ? kClamp * sum / count : 0.0;
    for (double& w : weight) {
      w = std::max(w, least);
    }
  }
  // The rows of the unknowns: diagonal and couplings among them in `inner`
  // (lower triangle), couplings to given vertices in `outer`, on the right
  // side.
  std::vector<Eigen::Triplet<double>> inner;
  std::vector<Eigen::Triplet<double>> outer;
  inner.reserve(static_cast<std::size_t>(unknowns) + 3 * edges.size());
  for (int i = 0; i < unknowns; ++i) {
    inner.emplace_back(i, i, 0.0);
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (used[e] == 0) {
      continue;
    }
    const int i = unknown_of[edges[e][0]];
    const int j = unknown_of[edges[e][1]];
    if (i >= 0) {
      inner.emplace_back(i, i, weight[e]);
    }
    if (j >= 0) {
      inner.emplace_back(j, j, weight[e]);
    }
    if (i >= 0 && j >= 0) {
      inner.emplace_back(std::max(i, j), std::min(i, j), -weight[e]);
    } else if (i >= 0) {
      outer.emplace_back(i, edges[e][1], weight[e]);
    } else if (j >= 0) {
      outer.emplace_back(j, edges[e][0], weight[e]);
    }
  }
  LaplaceSystem system;
  system.inner.resize(unknowns, unknowns);
  system.inner.setFromTriplets(inner.begin(), inner.end());
  system.inner.makeCompressed();
  system.outer.resize(unknowns, static_cast<int>(mesh.points.size()));
  system.outer.setFromTriplets(outer.begin(), outer.end());
  system.outer.makeCompressed();
  return system;
}

}  // namespace meniscus::energy
