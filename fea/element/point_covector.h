/// What a number changes by the fields at the integration points
/// (point_stress.h): where the transposes of recovery meet.
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/point_stress.h"

namespace meniscus::element {

/// By the six components of stress at each point, by its place and by its
/// volume, each with the others held; and by node positions, all points held.
struct PointCovector {
  std::vector<Stress> stress;  // [value/pressure]
  Points position;             // [value/length]
  std::vector<double> volume;  // [value/length^3]
  Points nodes;                // of the mesh [value/length]

  PointCovector(const TetMesh& mesh, const PointStress& points)
      : stress(points.stress.size(), Stress{}),
        position(points.stress.size(), Vec3::Zero()),
        volume(points.stress.size(), 0.0),
        nodes(mesh.nodes.size(), Vec3::Zero()) {}
};

/// sum += factor * more.
inline void add_scaled(double factor, const Stress& more, Stress& sum) {
  for (std::size_t k = 0; k < sum.size(); ++k) {
    sum[k] += factor * more[k];
  }
}

/// Sum of products, component by component.
inline double dot(const Stress& a, const Stress& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += a[k] * b[k];
  }
  return sum;
}

inline bool is_zero(const Stress& s) { return s == Stress{}; }

}  // namespace meniscus::element
