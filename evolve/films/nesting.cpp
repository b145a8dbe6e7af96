#include "evolve/films/nesting.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/geometry/facet_pairs.h"
#include "core/math/union_find.h"
#include "evolve/films/film_gap.h"

namespace meniscus::films {

namespace {

// Area samples of a film that are asked where they lie.
constexpr int kSamples = 101;

using FacetPoints = std::array<Vec3, 3>;

void check_mesh(const SurfaceMesh& mesh, const std::vector<int>& films) {
  const auto labels = static_cast<int>(mesh.labels.size());
  for (const int film : films) {
    if (film < 0 || film >= labels) {
      throw MeshError(
          fmt::format("nesting: film {} of {} surfaces does not "
                      "exist",
                      film, labels));
    }
  }
  if (mesh.facet_label.size() != mesh.facets.size()) {
    throw MeshError(fmt::format("nesting: {} labels for {} facets",
                                mesh.facet_label.size(), mesh.facets.size()));
  }
  const auto points = static_cast<int>(mesh.points.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (const int v : mesh.facets[f]) {
      if (v < 0 || v >= points || !mesh.points[v].allFinite()) {
        throw MeshError(
            fmt::format("nesting: corner {} of facet {} is out of "
                        "range or not finite",
                        v, f));
      }
    }
    if (mesh.facet_label[f] < 0 || mesh.facet_label[f] >= labels) {
      throw MeshError(fmt::format("nesting: facet {} has label {} of {}", f,
                                  mesh.facet_label[f], labels));
    }
  }
}

/// One film's facets, and the triangles that close it: modulo 2, every edge of
/// an odd number of facets has a fan to its rim's centre.
class Shell {
 public:
  Shell(const SurfaceMesh& mesh, const std::vector<int>& facets) {
    std::map<Edge, int> count;
    for (const int f : facets) {
      const Triangle& t = mesh.facets[f];
      triangles_.push_back(
          {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]});
      for (int k = 0; k < 3; ++k) {
        const int a = t[k];
        const int b = t[(k + 1) % 3];
        ++count[edge_key(a, b)];
      }
    }
    std::erase_if(count, [](const auto& item) { return item.second % 2 == 0; });
    close(mesh, count);
  }

  /// By the majority of three rays, each in no special direction.
  bool contains(const Vec3& at) const {
    int votes = 0;
    for (const Vec3& ray :
         {Vec3(0.5377, 0.1834, 0.8229), Vec3(-0.7139, 0.6612, -0.2306),
          Vec3(0.2731, -0.8967, 0.3484)}) {
      int crossed = 0;
      for (const FacetPoints& t : triangles_) {
        crossed += meets(t, at, ray) ? 1 : 0;
      }
      votes += crossed % 2;
    }
    return votes >= 2;
  }

 private:
  void close(const SurfaceMesh& mesh, const std::map<Edge, int>& rim) {
    UnionFind lines(mesh.points.size());
    std::set<int> there;
    for (const auto& [edge, n] : rim) {
      there.insert(edge.begin(), edge.end());
      lines.join(edge[0], edge[1]);
    }
    std::map<int, std::pair<Vec3, int>> sums;
    for (const int v : there) {
      auto& [sum, n] =
          sums.try_emplace(lines.root(v), Vec3::Zero(), 0).first->second;
      sum += mesh.points[v];
      ++n;
    }
    for (const auto& [edge, n] : rim) {
      const auto& [sum, count] = sums.at(lines.root(edge[0]));
      triangles_.push_back({mesh.points[edge[0]], mesh.points[edge[1]],
                            Vec3(sum / static_cast<double>(count))});
    }
  }

  /// Moeller and Trumbore 1997.
  static bool meets(const FacetPoints& t, const Vec3& at, const Vec3& ray) {
    const Vec3 ab = t[1] - t[0];
    const Vec3 ac = t[2] - t[0];
    const Vec3 p = ray.cross(ac);
    const double det = ab.dot(p);
    if (det == 0.0) {
      return false;
    }
    const Vec3 s = at - t[0];
    const double u = s.dot(p) / det;
    const Vec3 q = s.cross(ab);
    const double v = ray.dot(q) / det;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && ac.dot(q) / det > 0.0;
  }

  std::vector<FacetPoints> triangles_;
};

/// Share of the film's area, by samples, within the shell.
double share_within(const SurfaceMesh& mesh, const std::vector<int>& facets,
                    const Shell& shell) {
  double total = 0.0;
  double within = 0.0;
  const std::size_t stride = std::max<std::size_t>(1, facets.size() / kSamples);
  for (std::size_t i = 0; i < facets.size(); i += stride) {
    const Triangle& t = mesh.facets[facets[i]];
    const double area = area_vector2(mesh, facets[i]).norm();
    const Vec3 middle =
        (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3.0;
    total += area;
    within += shell.contains(middle) ? area : 0.0;
  }
  return total > 0.0 ? within / total : 0.0;
}

/// Facets that hang together.
struct Group {
  std::string name;
  std::vector<int> facets;
};

class Nesting {
 public:
  Nesting(const SurfaceMesh& mesh, const std::vector<int>& films,
          const NestingOptions& options)
      : mesh_(mesh), options_(options) {
    std::vector<char> taken(mesh.labels.size(), 0);
    for (const int film : films) {
      taken[film] = 1;
    }
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      if (taken[mesh.facet_label[f]] != 0 &&
          area_vector2(mesh, static_cast<int>(f)).norm() > 0.0) {
        all_.push_back(static_cast<int>(f));
      }
    }
    group_facets();
  }

  NestingReport check() {
    find_crossings();
    if (groups_.size() <= static_cast<std::size_t>(options_.max_groups)) {
      find_gaps();
      find_order();
    }
    return std::move(report_);
  }

 private:
  void group_facets() {
    UnionFind joined(mesh_.points.size());
    for (const int f : all_) {
      const Triangle& t = mesh_.facets[f];
      joined.join(t[0], t[1]);
      joined.join(t[0], t[2]);
    }
    // Groups in the order of their first facets.
    std::map<int, int> group_at;  // by root
    group_of_.assign(mesh_.facets.size(), -1);
    for (const int f : all_) {
      const auto [at, is_new] = group_at.try_emplace(
          joined.root(mesh_.facets[f][0]), static_cast<int>(groups_.size()));
      if (is_new) {
        groups_.emplace_back();
      }
      group_of_[f] = at->second;
      groups_[at->second].facets.push_back(f);
    }
    name_groups();
  }

  void name_groups() {
    std::map<std::string, int> seen;
    for (Group& group : groups_) {
      std::set<int> films;
      for (const int f : group.facets) {
        films.insert(mesh_.facet_label[f]);
      }
      group.name = mesh_.labels[*films.begin()];
      if (films.size() > 1) {
        group.name += fmt::format(" and {} more", films.size() - 1);
      }
      const int times = ++seen[group.name];
      if (times > 1) {
        group.name += fmt::format(" ({})", times);
      }
    }
  }

  void find_crossings() {
    for_each_near_pair(mesh_, all_, 0.0, [&](int f, int g) {
      const PairVerdict verdict = classify_pair(mesh_, f, g, 0.0);
      if (verdict.state == PairState::Crossing) {
        const int film = mesh_.facet_label[f];
        const int other = mesh_.facet_label[g];
        crossed_[std::minmax(group_of_[f], group_of_[g])] = verdict.position;
        if (report_.crossing_pairs++ < options_.max_crossings) {
          report_.crossings.push_back({mesh_.labels[film],
                                       mesh_.labels[other],
                                       {f, g},
                                       verdict.position});
        }
      }
      return true;
    });
    report_.apart = report_.crossing_pairs == 0;
  }

  void find_gaps() {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      for (std::size_t j = i + 1; j < groups_.size(); ++j) {
        report_.gaps.push_back(gap_of(i, j));
      }
    }
  }

  GroupGap gap_of(std::size_t i, std::size_t j) const {
    GroupGap gap{groups_[i].name, groups_[j].name};
    const auto crossed =
        crossed_.find({static_cast<int>(i), static_cast<int>(j)});
    if (crossed != crossed_.end()) {
      gap.on_group = gap.on_other = crossed->second;
      return gap;
    }
    const ShortestLine line =
        shortest_line(mesh_, groups_[i].facets, groups_[j].facets);
    gap.gap = line.length;
    gap.on_group = line.from;
    gap.on_other = line.to;
    return gap;
  }

  void find_order() {
    std::vector<int> depth(groups_.size(), 0);
    for (std::size_t j = 0; groups_.size() > 1 && j < groups_.size(); ++j) {
      const Shell shell(mesh_, groups_[j].facets);
      for (std::size_t i = 0; i < groups_.size(); ++i) {
        if (i != j && share_within(mesh_, groups_[i].facets, shell) > 0.5) {
          report_.inside.push_back({groups_[i].name, groups_[j].name});
          ++depth[i];
        }
      }
    }
    std::vector<int> order(groups_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return depth[a] > depth[b]; });
    for (const int g : order) {
      report_.order.push_back(groups_[g].name);
    }
  }

  const SurfaceMesh& mesh_;
  NestingOptions options_;
  std::vector<int> all_;       // facets of the films
  std::vector<int> group_of_;  // of each facet, or -1
  std::vector<Group> groups_;
  std::map<std::pair<int, int>, Vec3> crossed_;  // groups
  NestingReport report_;
};

std::string place_text(const Vec3& at) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", at.x(), at.y(), at.z());
}

}  // namespace

NestingReport check_nesting(const SurfaceMesh& mesh,
                            const std::vector<int>& films,
                            const NestingOptions& options) {
  check_mesh(mesh, films);
  std::vector<int> all = films;
  if (all.empty()) {
    all.resize(mesh.labels.size());
    std::iota(all.begin(), all.end(), 0);
  }
  return Nesting(mesh, all, options).check();
}

std::string nesting_text(const NestingReport& report,
                         const std::string& length_unit) {
  if (!report.crossings.empty()) {
    const FilmCrossing& first = report.crossings.front();
    return fmt::format(
        "cross: {} pairs of facets; the first is facet {} of '{}' and {} of "
        "'{}' at {}; move their curves apart, or change a volume",
        report.crossing_pairs, first.facets[0], first.film, first.facets[1],
        first.other, place_text(first.position));
  }
  if (report.gaps.empty()) {
    return "";
  }
  const GroupGap& least = *std::min_element(
      report.gaps.begin(), report.gaps.end(),
      [](const GroupGap& a, const GroupGap& b) { return a.gap < b.gap; });
  std::string text = fmt::format(
      "apart, no two facets cross; least gap {:.6g}{}, of '{}' and '{}' at {}",
      least.gap, length_unit.empty() ? "" : " " + length_unit, least.group,
      least.other, place_text(least.on_group));
  if (!report.inside.empty()) {
    text += fmt::format("; inside out: {}", fmt::join(report.order, ", "));
  }
  return text;
}

}  // namespace meniscus::films
