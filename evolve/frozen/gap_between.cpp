#include "evolve/frozen/gap_between.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/geometry/facet_pairs.h"
#include "core/geometry/facet_tree.h"
#include "evolve/films/film_gap.h"
#include "evolve/frozen/film_model_impl.h"

namespace meniscus::frozen {

namespace {

/// What is so many smoothings further away than the nearest does not count:
/// below one rounding of the sum.
constexpr double kFar = 40.0;

std::vector<int> facets_of(const SurfaceMesh& mesh, int label) {
  std::vector<int> facets;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] == label) {
      facets.push_back(static_cast<int>(f));
    }
  }
  return facets;
}

std::vector<Edge> edges_of(const SurfaceMesh& mesh,
                           const std::vector<int>& facets) {
  std::vector<Edge> edges;
  edges.reserve(3 * facets.size());
  for (const int f : facets) {
    const Triangle& t = mesh.facets[f];
    for (std::size_t k = 0; k < 3; ++k) {
      edges.push_back(edge_key(t[k], t[(k + 1) % 3]));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

struct EdgeLine {
  Edge edge{};
  NearestLine line;
};

/// Of the edges that are nearer than `most`.
void add_lines(const SurfaceMesh& mesh, const std::vector<int>& from,
               const std::vector<int>& to, double most,
               std::vector<EdgeLine>& lines) {
  const FacetTree tree(mesh, to);
  for (const Edge& edge : edges_of(mesh, from)) {
    if (auto line =
            tree.nearest(mesh.points[edge[0]], mesh.points[edge[1]], most)) {
      lines.push_back({edge, *line});
    }
  }
}

/// The facets of one label against those of the other only.
void refuse_crossing(const SurfaceMesh& mesh, const std::vector<int>& film,
                     const std::vector<int>& other) {
  std::vector<int> facets = film;
  facets.insert(facets.end(), other.begin(), other.end());
  std::sort(facets.begin(), facets.end());
  for_each_near_pair(mesh, facets, 0.0, [&](int f, int g) {
    if (mesh.facet_label[f] != mesh.facet_label[g]) {
      const PairVerdict verdict = classify_pair(mesh, f, g, 0.0);
      if (verdict.state == PairState::Crossing) {
        const Vec3& at = verdict.position;
        throw InvalidInput(fmt::format(
            "films '{}' and '{}' cross near ({:.4g}, {:.4g}, {:.4g}): there is "
            "no gap between them; move their curves apart, or change a volume",
            mesh.labels[mesh.facet_label[film[0]]],
            mesh.labels[mesh.facet_label[other[0]]], at.x(), at.y(), at.z()));
      }
    }
    return true;
  });
}

struct FilmLines {
  double least = 0.0;
  std::vector<EdgeLine> lines;  // all that count
};

FilmLines lines_between(const SurfaceMesh& mesh, int film, int other,
                        double smoothing) {
  const auto labels = static_cast<int>(mesh.labels.size());
  if (film < 0 || other < 0 || film >= labels || other >= labels ||
      film == other) {
    throw InvalidInput("a gap needs two films");
  }
  const std::vector<int> here = facets_of(mesh, film);
  const std::vector<int> there = facets_of(mesh, other);
  if (here.empty() || there.empty()) {
    throw InvalidInput("a gap needs two films with facets");
  }
  refuse_crossing(mesh, here, there);
  const films::ShortestLine least = films::shortest_line(mesh, here, there);
  if (!(least.length > 0.0)) {
    const Vec3& at = least.from;
    throw InvalidInput(fmt::format(
        "films '{}' and '{}' touch at ({:.4g}, {:.4g}, {:.4g}): there is no "
        "gap between them",
        mesh.labels[film], mesh.labels[other], at.x(), at.y(), at.z()));
  }
  FilmLines result{.least = least.length, .lines = {}};
  const double most = least.length + kFar * smoothing;
  add_lines(mesh, here, there, most, result.lines);
  add_lines(mesh, there, here, most, result.lines);
  return result;
}

}  // namespace

FilmResponse gap_between(const SurfaceMesh& mesh, int film, int other,
                         double smoothing) {
  if (!(smoothing > 0.0) || !std::isfinite(smoothing)) {
    throw InvalidInput(fmt::format(
        "the smoothing of a gap must be above 0, found {}", smoothing));
  }
  const FilmLines between = lines_between(mesh, film, other, smoothing);
  double sum = 0.0;
  FilmResponse result;
  result.by.points.assign(mesh.points.size(), Vec3::Zero());
  for (const auto& [edge, line] : between.lines) {
    const NearestPoint& to = line.to;
    const double share = std::exp((between.least - to.distance) / smoothing);
    sum += share;
    const Vec3 by_place = share / to.distance * (line.from - to.point);
    result.by.points[edge[0]] += (1.0 - line.along) * by_place;
    result.by.points[edge[1]] += line.along * by_place;
    for (int k = 0; k < 3; ++k) {
      result.by.points[mesh.facets[to.facet][k]] -= to.weights[k] * by_place;
    }
  }
  for (Vec3& by_point : result.by.points) {
    by_point /= sum;
  }
  result.value = between.least - smoothing * std::log(sum);
  return result;
}

FilmResponse FilmModel::gap(const Points& points, const std::string& film,
                            const std::string& other, double smoothing) const {
  const SurfaceMesh mesh = fine_mesh(points);
  return gap_between(mesh, mesh.label_of(film), mesh.label_of(other),
                     smoothing);
}

}  // namespace meniscus::frozen
