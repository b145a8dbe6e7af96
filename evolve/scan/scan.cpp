#include "evolve/scan/scan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::scan {

namespace {

constexpr double kShare = 0.95;  // of vertices, of P95
/// A nearest place with a corner's weight below this lies on an edge.
constexpr double kOnEdge = 1e-9;
constexpr double kRounding = 1e-12;  // of the scan's diagonal

std::vector<int> sound_facets(const SurfaceMesh& mesh) {
  if (mesh.facets.empty()) {
    throw MeshError("the scan has no facets");
  }
  const auto points = static_cast<int>(mesh.points.size());
  std::vector<int> facets;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (const int v : mesh.facets[f]) {
      if (v < 0 || v >= points || !mesh.points[v].allFinite()) {
        throw MeshError(fmt::format(
            "scan: corner {} of facet {} is out of range or not finite", v, f));
      }
    }
    facets.push_back(static_cast<int>(f));
  }
  return facets;
}

/// The vertex of the distance that so many of all are not above.
std::size_t of_rank(const VectorX& values, double share) {
  std::vector<std::size_t> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) {
                     return std::abs(values[static_cast<Eigen::Index>(a)]) <
                            std::abs(values[static_cast<Eigen::Index>(b)]);
                   });
  const auto last = static_cast<double>(order.size());
  const auto rank = static_cast<std::size_t>(std::ceil(share * last));
  return order[std::max<std::size_t>(rank, 1) - 1];
}

}  // namespace

Scan::Scan(SurfaceMesh surface)
    : surface_(std::move(surface)),
      tree_(surface_, sound_facets(surface_)),
      rounding_(kRounding * bounding_diagonal(surface_.points)) {
  normals_.assign(surface_.points.size(), Vec3::Zero());
  for (std::size_t f = 0; f < surface_.facets.size(); ++f) {
    const Vec3 area2 = area_vector2(surface_, static_cast<int>(f));
    for (const int v : surface_.facets[f]) {
      normals_[v] += area2;
    }
  }
}

ScanPlace Scan::nearest(const Vec3& place) const {
  const NearestPoint found = *tree_.nearest(place);
  const Triangle& t = surface_.facets[found.facet];
  const bool inside =
      std::all_of(found.weights.begin(), found.weights.end(),
                  [](double weight) { return weight > kOnEdge; });
  Vec3 normal = area_vector2(surface_, found.facet);
  if (!inside) {
    normal.setZero();
    for (int k = 0; k < 3; ++k) {
      normal += found.weights[k] * normals_[t[k]];
    }
  }
  const Vec3 way = place - found.point;
  const double sign = way.dot(normal) < 0.0 ? -1.0 : 1.0;
  ScanPlace result{.distance = sign * found.distance, .on_scan = found.point};
  if (found.distance > rounding_) {
    result.direction = sign / found.distance * way;
  } else if (normal.squaredNorm() > 0.0) {
    result.direction = normal.normalized();
  }
  return result;
}

ScanDistances distances_to(const Scan& scan, const SurfaceMesh& film,
                           const std::vector<int>& labels) {
  std::vector<char> counts(film.points.size(), 0);
  for (std::size_t f = 0; f < film.facets.size(); ++f) {
    if (std::find(labels.begin(), labels.end(), film.facet_label[f]) !=
        labels.end()) {
      for (const int v : film.facets[f]) {
        counts[v] = 1;
      }
    }
  }
  ScanDistances result;
  for (std::size_t v = 0; v < counts.size(); ++v) {
    if (counts[v] != 0) {
      result.vertices.push_back(static_cast<int>(v));
    }
  }
  result.values.resize(static_cast<Eigen::Index>(result.vertices.size()));
  result.directions.resize(result.vertices.size());
  for (std::size_t k = 0; k < result.vertices.size(); ++k) {
    const ScanPlace place = scan.nearest(film.points[result.vertices[k]]);
    result.values[static_cast<Eigen::Index>(k)] = place.distance;
    result.directions[k] = place.direction;
  }
  return result;
}

frozen::FilmResponse measure(const ScanDistances& distances,
                             ScanMeasure measure, std::size_t vertices) {
  const VectorX& values = distances.values;
  const auto count = static_cast<double>(values.size());
  VectorX by = VectorX::Zero(values.size());
  frozen::FilmResponse result;
  switch (measure) {
    case ScanMeasure::Rms:
      result.value = std::sqrt(values.squaredNorm() / count);
      if (result.value > 0.0) {
        by = values / (count * result.value);
      }
      break;
    case ScanMeasure::Mean:
      result.value = values.cwiseAbs().sum() / count;
      by = values.cwiseSign() / count;
      break;
    case ScanMeasure::P95:
    case ScanMeasure::Largest: {
      const auto k = static_cast<Eigen::Index>(
          of_rank(values, measure == ScanMeasure::P95 ? kShare : 1.0));
      result.value = std::abs(values[k]);
      by[k] = values[k] < 0.0 ? -1.0 : 1.0;
      break;
    }
  }
  result.by.points.assign(vertices, Vec3::Zero());
  for (std::size_t k = 0; k < distances.vertices.size(); ++k) {
    result.by.points[distances.vertices[k]] =
        by[static_cast<Eigen::Index>(k)] * distances.directions[k];
  }
  return result;
}

}  // namespace meniscus::scan
