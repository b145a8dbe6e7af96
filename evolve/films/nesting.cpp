#include "evolve/films/nesting.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

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

class Nesting {
 public:
  Nesting(const SurfaceMesh& mesh, std::vector<int> films,
          const NestingOptions& options)
      : mesh_(mesh), films_(std::move(films)), options_(options) {
    std::vector<int> place(mesh.labels.size(), -1);
    for (std::size_t i = 0; i < films_.size(); ++i) {
      place[films_[i]] = static_cast<int>(i);
    }
    facets_.resize(films_.size());
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      const int i = place[mesh.facet_label[f]];
      if (i >= 0 && area_vector2(mesh, static_cast<int>(f)).norm() > 0.0) {
        facets_[i].push_back(static_cast<int>(f));
        all_.push_back(static_cast<int>(f));
      }
    }
  }

  NestingReport take() {
    find_crossings();
    find_gaps();
    find_order();
    say();
    return std::move(report_);
  }

 private:
  const std::string& name(std::size_t i) const {
    return mesh_.labels[films_[i]];
  }

  void find_crossings() {
    for_each_near_pair(mesh_, all_, 0.0, [&](int f, int g) {
      const PairVerdict verdict = classify_pair(mesh_, f, g, 0.0);
      if (verdict.state == PairState::Crossing) {
        crossed_[std::minmax(mesh_.facet_label[f], mesh_.facet_label[g])] =
            verdict.position;
        if (report_.crossing_pairs++ < options_.max_crossings) {
          report_.crossings.push_back({mesh_.labels[mesh_.facet_label[f]],
                                       mesh_.labels[mesh_.facet_label[g]],
                                       {f, g},
                                       verdict.position});
        }
      }
      return true;
    });
    report_.apart = report_.crossing_pairs == 0;
  }

  void find_gaps() {
    for (std::size_t i = 0; i < films_.size(); ++i) {
      for (std::size_t j = i + 1; j < films_.size(); ++j) {
        if (!facets_[i].empty() && !facets_[j].empty()) {
          report_.gaps.push_back(gap_between(i, j));
        }
      }
    }
  }

  FilmGap gap_between(std::size_t i, std::size_t j) const {
    FilmGap gap{name(i), name(j)};
    const auto crossed = crossed_.find(std::minmax(films_[i], films_[j]));
    if (crossed != crossed_.end()) {
      gap.on_film = gap.on_other = crossed->second;
      return gap;
    }
    const ShortestLine line = shortest_line(mesh_, facets_[i], facets_[j]);
    gap.gap = line.length;
    gap.on_film = line.from;
    gap.on_other = line.to;
    gap.joined = line.length == 0.0;
    return gap;
  }

  void find_order() {
    std::vector<Shell> shells;
    shells.reserve(films_.size());
    for (const auto& facets : facets_) {
      shells.emplace_back(mesh_, facets);
    }
    std::vector<int> depth(films_.size(), 0);
    for (std::size_t i = 0; i < films_.size(); ++i) {
      for (std::size_t j = 0; j < films_.size(); ++j) {
        if (i != j && share_within(mesh_, facets_[i], shells[j]) > 0.5) {
          report_.inside.push_back({name(i), name(j)});
          ++depth[i];
        }
      }
    }
    std::vector<int> order(films_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return depth[a] > depth[b]; });
    for (const int i : order) {
      report_.order.push_back(name(i));
    }
  }

  void say() {
    if (!report_.apart) {
      const FilmCrossing& first = report_.crossings.empty()
                                      ? FilmCrossing{}
                                      : report_.crossings.front();
      report_.verdict = fmt::format(
          "crossing: {} facet pairs; the first is facet {} of '{}' and {} of "
          "'{}' at ({:.6g}, {:.6g}, {:.6g}); move their curves apart or "
          "refine",
          report_.crossing_pairs, first.facets[0], first.film, first.facets[1],
          first.other, first.position.x(), first.position.y(),
          first.position.z());
      return;
    }
    const auto least = std::min_element(
        report_.gaps.begin(), report_.gaps.end(),
        [](const FilmGap& a, const FilmGap& b) { return a.gap < b.gap; });
    report_.verdict = "apart: no two facets cross";
    if (least != report_.gaps.end()) {
      report_.verdict += fmt::format(
          "; smallest gap {:.6g} between '{}' and '{}' at ({:.6g}, {:.6g}, "
          "{:.6g})",
          least->gap, least->film, least->other, least->on_film.x(),
          least->on_film.y(), least->on_film.z());
    }
  }

  const SurfaceMesh& mesh_;
  std::vector<int> films_;  // labels
  NestingOptions options_;
  std::vector<std::vector<int>> facets_;  // per film
  std::vector<int> all_;
  std::map<std::pair<int, int>, Vec3> crossed_;
  NestingReport report_;
};

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
  return Nesting(mesh, std::move(all), options).take();
}

NestingReport check_nesting(const FilmComplex& complex,
                            const NestingOptions& options) {
  std::vector<int> films;
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    if (complex.surfaces[s].liquid) {
      films.push_back(static_cast<int>(s));
    }
  }
  if (films.empty()) {
    throw MeshError("nesting: the complex has no liquid film");
  }
  return check_nesting(complex.mesh, films, options);
}

}  // namespace meniscus::films
