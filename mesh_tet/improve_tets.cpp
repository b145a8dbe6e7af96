#include "mesh_tet/improve_tets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

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

/// Along the axes and the diagonals of space.
std::array<Vec3, 14> make_directions() {
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
}

class Improver {
 public:
  Improver(TetMesh& mesh, int fixed, double bound)
      : mesh_(mesh),
        fixed_(fixed),
        bound_(bound),
        directions_(make_directions()),
        star_(mesh.nodes.size()),
        settled_(mesh.nodes.size(), 0),
        tried_(mesh.elements.size() / 4, 0) {
    for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
      star_[mesh.elements[i]].push_back(static_cast<int>(i / 4));
    }
    for (int f = 0; f < mesh.face_count(); ++f) {
      const auto ids = mesh.face(f);
      for (int k = 0; k < 3; ++k) {
        surface_edges_.insert(std::minmax(ids[k], ids[(k + 1) % 3]));
      }
    }
  }

  /// One pass over the elements; the number of changes.
  int sweep(ImproveReport& report) {
    int changes = 0;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      for (int k = 0; k < 4 && quality(e) < bound_; ++k) {
        const int node = mesh_.element(e)[k];
        if (node >= fixed_ && settled_[node] == 0 && improve(node)) {
          ++report.moved;
          ++changes;
        }
      }
      if (tried_[e] == 0 && quality(e) < bound_) {
        tried_[e] = 1;
        if (split_best_edge(e)) {
          ++report.split;
          ++changes;
        }
      }
    }
    return changes;
  }

 private:
  double quality(int e) const {
    const auto ids = mesh_.element(e);
    return quality_of({mesh_.nodes[ids[0]], mesh_.nodes[ids[1]],
                       mesh_.nodes[ids[2]], mesh_.nodes[ids[3]]});
  }

  double star_quality(int node) const {
    double worst = 2.0;
    for (const int e : star_[node]) {
      worst = std::min(worst, quality(e));
    }
    return worst;
  }

  double star_size(int node) const {
    double sum = 0.0;
    for (const int e : star_[node]) {
      for (const int other : mesh_.element(e)) {
        sum += (mesh_.nodes[other] - mesh_.nodes[node]).norm();
      }
    }
    return sum / (3.0 * static_cast<double>(star_[node].size()));
  }

  /// Pattern search for the position with the best worst element.
  bool improve(int node) {
    constexpr int kHalvings = 6;
    constexpr double kFirstStep = 0.3;  // x mean distance of neighbours
    const double before = star_quality(node);
    double best = before;
    double step = kFirstStep * star_size(node);
    for (int halving = 0; halving < kHalvings && best < 2.0 * bound_;
         ++halving) {
      while (try_step(node, step, best)) {
      }
      step *= 0.5;
    }
    if (best > before) {
      for (const int e : star_[node]) {
        for (const int other : mesh_.element(e)) {
          settled_[other] = 0;
        }
      }
    }
    settled_[node] = 1;
    return best > before;
  }

  /// Takes the best of the steps if it gains noticeably.
  bool try_step(int node, double step, double& best) {
    constexpr double kNoticeable = 1e-3;
    const Vec3 from = mesh_.nodes[node];
    Vec3 to = from;
    double found = best + kNoticeable;
    for (const Vec3& direction : directions_) {
      mesh_.nodes[node] = from + step * direction;
      const double at = star_quality(node);
      if (at > found) {
        found = at;
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

  /// Tries the inner edges of a bad element, longest first.
  bool split_best_edge(int e) {
    std::vector<std::pair<double, int>> order;
    const std::array<int, 4> ids = {mesh_.element(e)[0], mesh_.element(e)[1],
                                    mesh_.element(e)[2], mesh_.element(e)[3]};
    for (int k = 0; k < 6; ++k) {
      const int a = ids[kTetEdges[k][0]];
      const int b = ids[kTetEdges[k][1]];
      if (!surface_edges_.contains(std::minmax(a, b))) {
        order.emplace_back(-(mesh_.nodes[a] - mesh_.nodes[b]).norm(), k);
      }
    }
    std::sort(order.begin(), order.end());
    return std::any_of(order.begin(), order.end(), [&](const auto& entry) {
      const Edge& edge = kTetEdges[entry.second];
      return split(ids[edge[0]], ids[edge[1]]);
    });
  }

  /// Corner `old_node` of element e becomes `new_node`.
  void exchange(int e, int old_node, int new_node) {
    int* ids = &mesh_.elements[4 * static_cast<std::size_t>(e)];
    std::replace(ids, ids + 4, old_node, new_node);
  }

  /// A node in the middle of edge a-b, moved to its best place; undone when
  /// the worst element around is not better than before.
  bool split(int a, int b) {
    constexpr double kGain = 1.2;  // worth a node
    std::vector<int> around;
    double before = 2.0;
    for (const int e : star_[a]) {
      const auto ids = mesh_.element(e);
      if (std::find(ids.begin(), ids.end(), b) != ids.end()) {
        around.push_back(e);
        before = std::min(before, quality(e));
      }
    }
    const int node = static_cast<int>(mesh_.nodes.size());
    const std::size_t elements = mesh_.elements.size();
    mesh_.nodes.push_back(0.5 * (mesh_.nodes[a] + mesh_.nodes[b]));
    star_.emplace_back();
    settled_.push_back(0);
    for (const int e : around) {  // e keeps a, its copy gets b
      const int copy = mesh_.element_count();
      for (int k = 0; k < 4; ++k) {
        const int id = mesh_.elements[4 * e + k];
        mesh_.elements.push_back(id == a ? node : id);
      }
      exchange(e, b, node);
      star_[node].push_back(e);
      star_[node].push_back(copy);
    }
    improve(node);
    if (star_quality(node) <= kGain * before) {
      for (const int e : around) {
        exchange(e, node, b);
      }
      mesh_.nodes.pop_back();
      star_.pop_back();
      settled_.pop_back();
      mesh_.elements.resize(elements);
      return false;
    }
    commit(node, b, around, static_cast<int>(elements / 4));
    return true;
  }

  /// Stars of the other nodes after a split; new elements from `first` on.
  void commit(int node, int b, const std::vector<int>& around, int first) {
    for (const int e : around) {
      std::erase(star_[b], e);
      mesh_.element_region.push_back(mesh_.element_region[e]);
      tried_[e] = 0;
    }
    for (int e = first; e < mesh_.element_count(); ++e) {
      tried_.push_back(0);
      for (const int id : mesh_.element(e)) {
        settled_[id] = 0;
        if (id != node) {
          star_[id].push_back(e);
        }
      }
    }
    mesh_.corner_count = static_cast<int>(mesh_.nodes.size());
  }

  TetMesh& mesh_;
  int fixed_;
  double bound_;
  std::array<Vec3, 14> directions_;
  std::vector<std::vector<int>> star_;  // elements at each node
  std::vector<char> settled_;  // nodes that gain nothing where they are
  std::vector<char> tried_;    // elements whose edges gain nothing
  std::set<std::pair<int, int>> surface_edges_;
};

}  // namespace

ImproveReport improve_tets(TetMesh& mesh, int fixed,
                           const ImproveOptions& options) {
  ImproveReport report;
  const double bound = std::sin(options.below_deg * std::numbers::pi / 180.0);
  Improver improver(mesh, fixed, bound);
  for (int round = 0; round < options.rounds; ++round) {
    if (improver.sweep(report) == 0) {
      break;
    }
  }
  return report;
}

}  // namespace meniscus
