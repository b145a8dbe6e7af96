#include "mesh_tet/smooth_tets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh_tet/tet_quality.h"

namespace meniscus {

namespace {

/// Smallest sine of a dihedral angle, negative for inverted elements: small
/// for needle angles and for angles near 180 degrees alike.
double quality_of(const TetCorners& x) {
  double largest = 0.0;
  for (const double c : dihedral_cosines(x)) {
    largest = std::max(largest, c * c);
  }
  const double sine = std::sqrt(1.0 - std::min(1.0, largest));
  return tet_volume(x) > 0.0 ? sine : -1.0 - sine;
}

/// Elements at each node, in order of element.
class Stars {
 public:
  explicit Stars(const TetMesh& mesh) : start_(mesh.nodes.size() + 1, 0) {
    for (const int n : mesh.elements) {
      ++start_[n + 1];
    }
    for (std::size_t n = 1; n < start_.size(); ++n) {
      start_[n] += start_[n - 1];
    }
    elements_.resize(mesh.elements.size());
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
      elements_[next[mesh.elements[i]]++] = static_cast<int>(i / 4);
    }
  }
  std::span<const int> of(int node) const {
    return {elements_.data() + start_[node],
            static_cast<std::size_t>(start_[node + 1] - start_[node])};
  }

 private:
  std::vector<int> start_;
  std::vector<int> elements_;
};

class Smoother {
 public:
  explicit Smoother(TetMesh& mesh) : mesh_(mesh), stars_(mesh) {}

  double element_quality(int e) const {
    const auto ids = mesh_.element(e);
    return quality_of({mesh_.nodes[ids[0]], mesh_.nodes[ids[1]],
                       mesh_.nodes[ids[2]], mesh_.nodes[ids[3]]});
  }

  /// Pattern search for the position with the best worst element.
  bool improve(int node) {
    constexpr int kHalvings = 6;
    constexpr double kFirstStep = 0.3;  // x mean distance of neighbours
    double best = star_quality(node);
    const double before = best;
    double step = kFirstStep * star_size(node);
    for (int halving = 0; halving < kHalvings; ++halving) {
      while (try_step(node, step, best)) {
      }
      step *= 0.5;
    }
    return best > before;
  }

 private:
  double star_quality(int node) const {
    double worst = 2.0;
    for (const int e : stars_.of(node)) {
      worst = std::min(worst, element_quality(e));
    }
    return worst;
  }

  double star_size(int node) const {
    double sum = 0.0;
    for (const int e : stars_.of(node)) {
      for (const int other : mesh_.element(e)) {
        sum += (mesh_.nodes[other] - mesh_.nodes[node]).norm();
      }
    }
    return sum / (3.0 * static_cast<double>(stars_.of(node).size()));
  }

  /// Takes the best of 14 steps if it gains noticeably.
  bool try_step(int node, double step, double& best) {
    constexpr double kNoticeable = 1e-3;
    const Vec3 from = mesh_.nodes[node];
    Vec3 to = from;
    double found = best + kNoticeable;
    for (const Vec3& direction : directions()) {
      mesh_.nodes[node] = from + step * direction;
      const double quality = star_quality(node);
      if (quality > found) {
        found = quality;
        to = mesh_.nodes[node];
      }
    }
    mesh_.nodes[node] = to;
    if (to == from) {
      return false;
    }
    best = found;
    return true;
  }

  /// Along the axes and the diagonals of space.
  static const std::array<Vec3, 14>& directions() {
    static const std::array<Vec3, 14> kDirections = [] {
      std::array<Vec3, 14> d;
      int n = 0;
      for (int axis = 0; axis < 3; ++axis) {
        d[n++] = Vec3::Unit(axis);
        d[n++] = -Vec3::Unit(axis);
      }
      for (int corner = 0; corner < 8; ++corner) {
        d[n++] = Vec3((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                      (corner & 4) != 0 ? 1 : -1) /
                 std::numbers::sqrt3;
      }
      return d;
    }();
    return kDirections;
  }

  TetMesh& mesh_;
  Stars stars_;
};

}  // namespace

int smooth_inner_nodes(TetMesh& mesh, int fixed, const SmoothOptions& options) {
  const double bound = std::sin(options.below_deg * std::numbers::pi / 180.0);
  Smoother smoother(mesh);
  std::vector<char> moved(mesh.nodes.size(), 0);
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    bool any = false;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const auto ids = mesh.element(e);
      for (int k = 0; k < 4 && smoother.element_quality(e) < bound; ++k) {
        if (ids[k] >= fixed && smoother.improve(ids[k])) {
          any = true;
          moved[ids[k]] = 1;
        }
      }
    }
    if (!any) {
      break;
    }
  }
  return static_cast<int>(std::count(moved.begin(), moved.end(), 1));
}

}  // namespace meniscus
