#include "fea/stress/patch_recovery.h"

#include <algorithm>
#include <array>
#include <optional>

#include "fea/element/node_elements.h"
#include "fea/stress/stress_patch.h"

namespace meniscus::stress {

namespace {

/// Nodes handed to a thread at a time: corners cost more than mid-sides.
constexpr int kShare = 128;

/// On boundaries the weights' reach over the mean distance of the nearest
/// ring's points. Smaller values follow peaks more closely and estimate coarse
/// meshes' errors better, larger ones smooth more; between 2.3 and 3 peaks
/// change by 0.5 %.
constexpr double kReach = 2.6;

class Recovery {
 public:
  Recovery(const TetMesh& mesh, const element::PointStress& points,
           const element::RegionNodes& nodes)
      : mesh_(mesh),
        points_(points),
        nodes_(nodes),
        around_(element::node_elements(nodes.elements, nodes.nodes_per_element,
                                       4, nodes.count())),
        inner_(element::surrounded_corners(nodes)),
        patch_of_(nodes.count(), -1) {
    int corners = 0;
    for (int i = 0; i < nodes.count(); ++i) {
      if (!around_.of(i).empty()) {
        patch_of_[i] = corners++;
      }
    }
    patch_.resize(corners);
  }

  std::vector<element::Stress> recover() {
    const int count = nodes_.count();
    const std::vector<Edge> ends = mid_side_ends();
    std::vector<element::Stress> value(count, element::Stress{});
#pragma omp parallel
    {
      Samples samples;
#pragma omp for schedule(dynamic, kShare)
      for (int i = 0; i < count; ++i) {
        if (patch_of_[i] >= 0) {
          patch_[patch_of_[i]] = fit(i, samples);
          value[i] = patch_[patch_of_[i]].at(place(i));
        }
      }
#pragma omp for schedule(dynamic, kShare)
      for (int i = 0; i < count; ++i) {
        if (ends[i][0] >= 0) {
          const element::Stress a = patch_[patch_of_[ends[i][0]]].at(place(i));
          const element::Stress b = patch_[patch_of_[ends[i][1]]].at(place(i));
          for (int k = 0; k < 6; ++k) {
            value[i][k] = 0.5 * (a[k] + b[k]);
          }
        }
      }
    }
    return value;
  }

  void transpose(const std::vector<element::Stress>& by_value,
                 element::PointCovector& by) const;

 private:
  const Vec3& place(int i) const { return mesh_.nodes[nodes_.node[i]]; }

  static void sort_unique(std::vector<int>& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  }

  /// What the polynomial of corner i is fitted to.
  struct Samples {
    std::vector<int> elements;
    PatchOptions options;
  };

  void find_samples(int i, Samples& samples) const {
    const auto near = around_.of(i);
    samples.options = {.degree = mesh_.order, .reach = std::nullopt};
    if (inner_[i] != 0) {
      samples.elements.assign(near.begin(), near.end());
      return;
    }
    std::vector<int> corners;
    double distance = 0.0;
    for (const int e : near) {
      const auto ids = nodes_.element(e).first<4>();
      corners.insert(corners.end(), ids.begin(), ids.end());
      for (int q = 0; q < points_.points_per_element; ++q) {
        distance += (points_.position[points_.index(e, q)] - place(i)).norm();
      }
    }
    sort_unique(corners);
    samples.elements.clear();
    for (const int c : corners) {
      const auto further = around_.of(c);
      samples.elements.insert(samples.elements.end(), further.begin(),
                              further.end());
    }
    sort_unique(samples.elements);
    samples.options.reach = kReach * distance / near_count(i);
  }

  /// The points of the nearest ring.
  double near_count(int i) const {
    return static_cast<double>(around_.of(i).size()) *
           points_.points_per_element;
  }

  StressPatch fit(int i, Samples& samples) const {
    find_samples(i, samples);
    return fit_patch(points_, samples.elements, place(i), samples.options);
  }

  /// A value that corner i's patch has a part in, and how much.
  struct Use {
    int copy = 0;
    double part = 1.0;
  };
  FitCovector transpose(int i, const std::vector<Use>& uses,
                        const std::vector<element::Stress>& by_value,
                        Points& by_place) const;

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

  const TetMesh& mesh_;
  const element::PointStress& points_;
  const element::RegionNodes& nodes_;
  element::NodeElements around_;  // of corners
  std::vector<char> inner_;
  std::vector<int> patch_of_;  // corners only, else -1
  std::vector<StressPatch> patch_;
};

/// `by_place`: receives what the number changes by where each use is read.
FitCovector Recovery::transpose(int i, const std::vector<Use>& uses,
                                const std::vector<element::Stress>& by_value,
                                Points& by_place) const {
  Samples samples;
  const StressPatch patch = fit(i, samples);
  Eigen::Matrix<double, StressPatch::kTerms, 6> by_coefficient;
  by_coefficient.setZero();
  Vec3 centre = Vec3::Zero();
  for (const Use& use : uses) {
    element::Stress g{};
    element::add_scaled(use.part, by_value[use.copy], g);
    const PatchValueCovector read = transpose_value(patch, place(use.copy), g);
    by_coefficient += read.coefficient;
    by_place.push_back(read.x);
    centre -= read.x;
  }
  FitCovector by = transpose_fit(points_, samples.elements, patch,
                                 samples.options, by_coefficient);
  by.centre += centre;
  if (by.reach != 0.0) {
    // The reach is a mean distance of the nearest ring's points.
    const double part = kReach / near_count(i) * by.reach;
    for (const int e : around_.of(i)) {
      for (int q = 0; q < points_.points_per_element; ++q) {
        const std::size_t at = points_.index(e, q);
        const Vec3 y = points_.position[at] - place(i);
        const Vec3 slope = part / y.norm() * y;
        by.samples.push_back({.point = at, .stress = {}, .position = slope});
        by.centre -= slope;
      }
    }
  }
  return by;
}

void Recovery::transpose(const std::vector<element::Stress>& by_value,
                         element::PointCovector& by) const {
  // 1. Which patches have a part.
  const std::vector<Edge> ends = mid_side_ends();
  std::vector<std::vector<Use>> uses(patch_.size());
  std::vector<int> corner_of(patch_.size(), 0);
  for (int i = 0; i < nodes_.count(); ++i) {
    if (patch_of_[i] >= 0) {
      corner_of[patch_of_[i]] = i;
    }
    if (element::is_zero(by_value[i])) {
      continue;
    }
    if (ends[i][0] >= 0) {
      uses[patch_of_[ends[i][0]]].push_back({i, 0.5});
      uses[patch_of_[ends[i][1]]].push_back({i, 0.5});
    } else if (patch_of_[i] >= 0) {
      uses[patch_of_[i]].push_back({i, 1.0});
    }
  }
  std::vector<int> open;
  for (int p = 0; p < static_cast<int>(uses.size()); ++p) {
    if (!uses[p].empty()) {
      open.push_back(p);
    }
  }
  // 2. Each by itself, in blocks that bound the memory; their sums in order.
  constexpr int kBlock = 1024;
  const int count = static_cast<int>(open.size());
  for (int first = 0; first < count; first += kBlock) {
    const int last = std::min(first + kBlock, count);
    std::vector<FitCovector> fits(last - first);
    std::vector<Points> places(last - first);
#pragma omp parallel for schedule(dynamic, 8)
    for (int k = first; k < last; ++k) {
      fits[k - first] = transpose(corner_of[open[k]], uses[open[k]], by_value,
                                  places[k - first]);
    }
    for (int k = first; k < last; ++k) {
      const int p = open[k];
      for (const FitCovector::Sample& sample : fits[k - first].samples) {
        element::add_scaled(1.0, sample.stress, by.stress[sample.point]);
        by.position[sample.point] += sample.position;
      }
      by.nodes[nodes_.node[corner_of[p]]] += fits[k - first].centre;
      for (std::size_t u = 0; u < uses[p].size(); ++u) {
        by.nodes[nodes_.node[uses[p][u].copy]] += places[k - first][u];
      }
    }
  }
}

}  // namespace

RecoveredStress recover_by_patches(const TetMesh& mesh,
                                   const element::PointStress& points) {
  RecoveredStress result;
  result.nodes = element::region_nodes(mesh);
  result.value = Recovery(mesh, points, result.nodes).recover();
  return result;
}

void transpose_patches(const TetMesh& mesh, const element::PointStress& points,
                       const element::RegionNodes& nodes,
                       const std::vector<element::Stress>& by_value,
                       element::PointCovector& by) {
  Recovery(mesh, points, nodes).transpose(by_value, by);
}

StressField nodal_stress(const TetMesh& mesh,
                         const RecoveredStress& recovered) {
  const std::size_t count = mesh.nodes.size();
  StressField field;
  field.nodal.assign(
      recovered.value.begin(),
      recovered.value.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t copy = count; copy < recovered.value.size(); ++copy) {
    element::Stress& here = field.nodal[recovered.nodes.node[copy]];
    if (element::von_mises(recovered.value[copy]) > element::von_mises(here)) {
      here = recovered.value[copy];
    }
  }
  find_peak(field);
  return field;
}

}  // namespace meniscus::stress
