#include "evolve/frozen/gap_between.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/facet_pairs.h"
#include "core/geometry/facet_tree.h"
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

std::vector<int> vertices_of(const SurfaceMesh& mesh,
                             const std::vector<int>& facets) {
  std::vector<int> vertices;
  for (const int f : facets) {
    const Triangle& t = mesh.facets[f];
    vertices.insert(vertices.end(), t.begin(), t.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

struct Pair {
  int vertex = 0;
  NearestPoint nearest;
};

void add_pairs(const SurfaceMesh& mesh, const std::vector<int>& from,
               const std::vector<int>& to, std::vector<Pair>& pairs) {
  const FacetTree tree(mesh, to);
  for (const int v : vertices_of(mesh, from)) {
    pairs.push_back({v, *tree.nearest(mesh.points[v])});
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

std::vector<Pair> pairs_between(const SurfaceMesh& mesh, int film, int other) {
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
  std::vector<Pair> pairs;
  add_pairs(mesh, here, there, pairs);
  add_pairs(mesh, there, here, pairs);
  for (const Pair& pair : pairs) {
    if (!(pair.nearest.distance > 0.0)) {
      const Vec3& at = pair.nearest.point;
      throw InvalidInput(fmt::format(
          "films '{}' and '{}' touch at ({:.4g}, {:.4g}, {:.4g}): there is no "
          "gap between them",
          mesh.labels[film], mesh.labels[other], at.x(), at.y(), at.z()));
    }
  }
  return pairs;
}

}  // namespace

FilmResponse gap_between(const SurfaceMesh& mesh, int film, int other,
                         double smoothing) {
  if (!(smoothing > 0.0) || !std::isfinite(smoothing)) {
    throw InvalidInput(fmt::format(
        "the smoothing of a gap must be above 0, found {}", smoothing));
  }
  const std::vector<Pair> pairs = pairs_between(mesh, film, other);
  double least = std::numeric_limits<double>::infinity();
  for (const Pair& pair : pairs) {
    least = std::min(least, pair.nearest.distance);
  }
  double sum = 0.0;
  FilmResponse result;
  result.by.points.assign(mesh.points.size(), Vec3::Zero());
  for (const Pair& pair : pairs) {
    const NearestPoint& to = pair.nearest;
    const double further = (to.distance - least) / smoothing;
    if (further > kFar) {
      continue;
    }
    const double share = std::exp(-further);
    sum += share;
    const Vec3 by_place =
        share / to.distance * (mesh.points[pair.vertex] - to.point);
    result.by.points[pair.vertex] += by_place;
    for (int k = 0; k < 3; ++k) {
      result.by.points[mesh.facets[to.facet][k]] -= to.weights[k] * by_place;
    }
  }
  for (Vec3& by_point : result.by.points) {
    by_point /= sum;
  }
  result.value = least - smoothing * std::log(sum);
  return result;
}

FilmResponse FilmModel::gap(const Points& points, const std::string& film,
                            const std::string& other, double smoothing) const {
  const SurfaceMesh mesh = fine_mesh(points);
  return gap_between(mesh, mesh.label_of(film), mesh.label_of(other),
                     smoothing);
}

}  // namespace meniscus::frozen
