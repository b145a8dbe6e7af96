#include "fea/patch_recovery.h"

#include <algorithm>
#include <array>

#include "fea/node_elements.h"
#include "fea/stress_patch.h"

namespace meniscus {

namespace {

/// Nodes handed to a thread at a time: corners cost more than mid-sides.
constexpr int kShare = 128;

class Recovery {
 public:
  Recovery(const TetMesh& mesh, const PointStress& points,
           const RegionNodes& nodes)
      : mesh_(mesh),
        points_(points),
        nodes_(nodes),
        around_(node_elements(nodes.elements, nodes.nodes_per_element, 4,
                              nodes.count())),
        inner_(surrounded_corners(nodes)) {}

  std::vector<Stress> recover() {
    fit();
    const std::vector<Edge> ends = mid_side_ends();
    std::vector<Stress> value(nodes_.count(), Stress{});
    const int count = nodes_.count();
#pragma omp parallel
    {
      std::vector<int> patches;
#pragma omp for schedule(dynamic, kShare)
      for (int i = 0; i < count; ++i) {
        patches.clear();
        if (!around_.of(i).empty()) {
          corner_patches(i, patches);
        } else if (ends[i][0] >= 0) {
          mid_side_patches(ends[i], patches);
        }
        value[i] = mean(patches, mesh_.nodes[nodes_.node[i]]);
      }
    }
    return value;
  }

 private:
  /// Polynomials of all surrounded corners and of those without such a
  /// neighbour.
  void fit() {
    const int count = nodes_.count();
    patch_.resize(count);
#pragma omp parallel
    {
      std::vector<int> patches;
#pragma omp for schedule(dynamic, kShare)
      for (int i = 0; i < count; ++i) {
        patches.clear();
        if (around_.of(i).empty()) {
          continue;
        }
        corner_patches(i, patches);
        if (patches.front() == i) {
          // Quadratics seen from one side only overshoot.
          patch_[i] =
              fit_patch(points_, around_.of(i), mesh_.nodes[nodes_.node[i]],
                        inner_[i] != 0 ? mesh_.order : 1);
        }
      }
    }
  }

  /// The two corners of each mid-side node; -1 for corners.
  std::vector<Edge> mid_side_ends() const {
    std::vector<Edge> ends(nodes_.count(), Edge{-1, -1});
    if (mesh_.order == 2) {
      for (int e = 0; e < mesh_.element_count(); ++e) {
        const auto ids = nodes_.element(e);
        for (int m = 0; m < 6; ++m) {
          ends[ids[4 + m]] = {ids[kTetEdges[m][0]], ids[kTetEdges[m][1]]};
        }
      }
    }
    return ends;
  }

  static void sort_unique(std::vector<int>& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  }

  /// Adds the surrounded corners of the elements around corner i that also
  /// hold `with`.
  void add_neighbours(int i, int with, std::vector<int>& patches) const {
    for (const int e : around_.of(i)) {
      const auto corners = nodes_.element(e).first<4>();
      if (std::find(corners.begin(), corners.end(), with) == corners.end()) {
        continue;
      }
      for (const int c : corners) {
        if (inner_[c] != 0) {
          patches.push_back(c);
        }
      }
    }
    sort_unique(patches);
  }

  /// The same one element farther, for corners in the edges of a body.
  void add_far_neighbours(int i, std::vector<int>& patches) const {
    for (const int e : around_.of(i)) {
      for (const int c : nodes_.element(e).first<4>()) {
        for (const int f : around_.of(c)) {
          for (const int d : nodes_.element(f).first<4>()) {
            if (inner_[d] != 0) {
              patches.push_back(d);
            }
          }
        }
      }
    }
    sort_unique(patches);
  }

  void corner_patches(int i, std::vector<int>& patches) const {
    if (inner_[i] == 0) {
      add_neighbours(i, i, patches);
      if (patches.empty()) {
        add_far_neighbours(i, patches);
      }
    }
    if (patches.empty()) {
      patches.push_back(i);
    }
  }

  void mid_side_patches(const Edge& ends, std::vector<int>& patches) const {
    for (const int c : ends) {
      if (inner_[c] != 0) {
        patches.push_back(c);
      }
    }
    if (patches.empty()) {
      add_neighbours(ends[0], ends[1], patches);
    }
    if (patches.empty()) {
      corner_patches(ends[0], patches);
      std::vector<int> others;
      corner_patches(ends[1], others);
      patches.insert(patches.end(), others.begin(), others.end());
      sort_unique(patches);
    }
  }

  Stress mean(const std::vector<int>& patches, const Vec3& x) const {
    Stress sum{};
    for (const int p : patches) {
      const Stress s = patch_[p].at(x);
      for (int k = 0; k < 6; ++k) {
        sum[k] += s[k] / static_cast<double>(patches.size());
      }
    }
    return sum;
  }

  const TetMesh& mesh_;
  const PointStress& points_;
  const RegionNodes& nodes_;
  NodeElements around_;  // of corners
  std::vector<char> inner_;
  std::vector<StressPatch> patch_;
};

}  // namespace

RecoveredStress recover_by_patches(const TetMesh& mesh,
                                   const PointStress& points) {
  RecoveredStress result;
  result.nodes = region_nodes(mesh);
  result.value = Recovery(mesh, points, result.nodes).recover();
  return result;
}

StressField nodal_stress(const TetMesh& mesh,
                         const RecoveredStress& recovered) {
  const std::size_t count = mesh.nodes.size();
  StressField field;
  field.nodal.assign(
      recovered.value.begin(),
      recovered.value.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t copy = count; copy < recovered.value.size(); ++copy) {
    Stress& here = field.nodal[recovered.nodes.node[copy]];
    if (von_mises(recovered.value[copy]) > von_mises(here)) {
      here = recovered.value[copy];
    }
  }
  find_peak(field);
  return field;
}

}  // namespace meniscus
