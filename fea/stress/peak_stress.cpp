#include "fea/stress/peak_stress.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace meniscus::stress {

namespace {

/// visit(von Mises, place, region) of every node of every element, where both
/// count.
template <class Visit>
void visit_nodes(const TetMesh& mesh, const RecoveredStress& stress,
                 const Excluded& excluded, const Visit& visit) {
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (const int copy : stress.nodes.element(e)) {
      const int node = stress.nodes.node[copy];
      if (excluded.counts(e, node)) {
        visit(element::von_mises(stress.value[copy]), mesh.nodes[node],
              mesh.element_region[e]);
      }
    }
  }
}

int nearest_corner(const TetMesh& mesh, int e, const Vec3& place) {
  const auto corners = mesh.element(e).first<4>();
  return *std::min_element(corners.begin(), corners.end(), [&](int a, int b) {
    return (mesh.nodes[a] - place).squaredNorm() <
           (mesh.nodes[b] - place).squaredNorm();
  });
}

/// The same of integration points, which go with their nearest corner.
template <class Visit>
void visit_points(const TetMesh& mesh, const element::PointStress& points,
                  const Excluded& excluded, const Visit& visit) {
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int q = 0; q < points.points_per_element; ++q) {
      const std::size_t at = points.index(e, q);
      const Vec3& place = points.position[at];
      if (excluded.counts(e, nearest_corner(mesh, e, place))) {
        visit(element::von_mises(points.stress[at]), place,
              mesh.element_region[e]);
      }
    }
  }
}

/// Keeps the largest of what it visits, the first of equals.
class Largest {
 public:
  explicit Largest(Peak& peak) : peak_(peak) {}
  void operator()(double von_mises, const Vec3& position, int region) const {
    if (von_mises > peak_.von_mises) {
      peak_ = {von_mises, position, region};
    }
  }

 private:
  Peak& peak_;
};

}  // namespace

Peak peak_of(const TetMesh& mesh, const RecoveredStress& stress,
             const Excluded& excluded) {
  Peak peak;
  visit_nodes(mesh, stress, excluded, Largest(peak));
  return peak;
}

const Peak& PeakReadings::largest() const {
  const Peak& nodal =
      averaged.von_mises > recovered.von_mises ? averaged : recovered;
  return points.von_mises > nodal.von_mises ? points : nodal;
}

PeakReadings peak_readings(const StressReadings& stress,
                           const Excluded& excluded) {
  PeakReadings peaks{
      .recovered = peak_of(stress.mesh, stress.recovered, excluded),
      .averaged = peak_of(stress.mesh, stress.averaged, excluded),
      .points = {}};
  visit_points(stress.mesh, stress.points, excluded, Largest(peaks.points));
  return peaks;
}

bool one_element_through(const TetMesh& mesh, const Vec3& position,
                         int region) {
  constexpr int kRings = 2;  // a sharp edge alone may have no inner corner
  const int corners = mesh.corner_count;
  std::vector<char> outside(static_cast<std::size_t>(corners), 0);
  for (int f = 0; f < mesh.face_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      outside[mesh.face(f)[k]] = 1;
    }
  }
  // 1. The nearest corner node of the region.
  std::vector<char> reached(static_cast<std::size_t>(corners), 0);
  int nearest = -1;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int k = 0; k < 4 && mesh.element_region[e] == region; ++k) {
      const int node = mesh.element(e)[k];
      if (nearest < 0 || (mesh.nodes[node] - position).squaredNorm() <
                             (mesh.nodes[nearest] - position).squaredNorm()) {
        nearest = node;
      }
    }
  }
  if (nearest < 0) {
    return false;
  }
  reached[nearest] = 1;
  // 2. Ring by ring: does an element have a corner inside?
  for (int ring = 0; ring < kRings; ++ring) {
    std::vector<char> next = reached;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const auto element = mesh.element(e).first(4);
      if (mesh.element_region[e] != region ||
          std::none_of(element.begin(), element.end(),
                       [&](int node) { return reached[node] != 0; })) {
        continue;
      }
      for (const int node : element) {
        if (outside[node] == 0) {
          return false;
        }
        next[node] = 1;
      }
    }
    reached = std::move(next);
  }
  return true;
}

SafetyFactor safety_factor(const StressReadings& stress,
                           const std::vector<element::Material>& materials,
                           const Excluded& excluded) {
  element::check_materials(stress.mesh, materials);
  SafetyFactor result{.smallest = std::numeric_limits<double>::infinity()};
  const auto keep_least = [&](double von_mises, const Vec3& position,
                              int region) {
    const std::optional<double>& strength = materials[region].yield_strength;
    if (strength && von_mises > 0.0 &&
        *strength / von_mises < result.smallest) {
      result = {*strength / von_mises, position, region, von_mises};
    }
  };
  visit_nodes(stress.mesh, stress.recovered, excluded, keep_least);
  visit_nodes(stress.mesh, stress.averaged, excluded, keep_least);
  visit_points(stress.mesh, stress.points, excluded, keep_least);
  return result;
}

}  // namespace meniscus::stress
