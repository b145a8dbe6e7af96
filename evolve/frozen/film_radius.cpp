#include "evolve/frozen/film_radius.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/energy/facet_terms.h"

namespace meniscus::frozen {

namespace {

constexpr int kLeastPower = 2;
constexpr int kMostPower = 64;

/// How the unit normals at a facet's corners vary over it.
struct FacetBend {
  energy::FacetFrame frame;
  std::array<Vec3, 3> normal;  // n_i
  std::array<Vec3, 3> slope;   // g_i
  Mat3 bend = Mat3::Zero();    // G [1/length]

  FacetBend(const Points& points, const Triangle& t,
            const std::array<Vec3, 3>& normals)
      : frame(points[t[0]], points[t[1]], points[t[2]]), normal(normals) {
    for (int i = 0; i < 3; ++i) {
      slope[i] = frame.normal.cross(frame.opposite[i]) / frame.area2;
      bend += normal[i] * slope[i].transpose();
    }
  }

  /// From a gradient by G: adds those by the normals and by the corners.
  void transpose(const Mat3& by_bend, std::array<Vec3, 3>& by_normal,
                 std::array<Vec3, 3>& by_corner) const {
    Vec3 by_area_vector = Vec3::Zero();  // by N
    std::array<Vec3, 3> by_opposite;     // by e_i: g_i = N x e_i / |N|^2
    for (int i = 0; i < 3; ++i) {
      by_normal[i] += by_bend * slope[i];
      const Vec3 by_slope = by_bend.transpose() * normal[i];
      by_opposite[i] = by_slope.cross(frame.normal) / frame.area2;
      by_area_vector += (frame.opposite[i].cross(by_slope) / frame.area2 -
                         2.0 * by_slope.dot(slope[i]) * frame.normal) /
                        frame.area2;
    }
    for (int i = 0; i < 3; ++i) {
      by_corner[i] += by_area_vector.cross(frame.opposite[i]) +
                      by_opposite[(i + 1) % 3] - by_opposite[(i + 2) % 3];
    }
  }
};

Mat3 power_of(const Mat3& m, int n) {
  Mat3 result = Mat3::Identity();
  for (int k = 0; k < n; ++k) {
    result = result * m;
  }
  return result;
}

/// Facets of films whose corners are all smooth and free, on no wall.
std::vector<int> smooth_facets(const energy::FilmEnergy& energy) {
  const energy::FilmSpace& space = energy.space();
  std::vector<int> result;
  for (std::size_t f = 0; f < energy.facets().size(); ++f) {
    const Triangle& t = energy.facets()[f];
    const auto facet = static_cast<int>(f);
    if (energy.is_liquid(facet) && std::all_of(t.begin(), t.end(), [&](int v) {
          return space.rank(v) == 1 && space.line_ends(v)[0] < 0;
        })) {
      result.push_back(facet);
    }
  }
  return result;
}

/// The facets' bends and their powers' sum.
struct Bends {
  std::vector<int> facets;
  std::vector<FacetBend> bends;
  double most = 0.0;  // keeps powers in range; any number would do
  std::vector<double> trace;
  double sum = 0.0;
  double area = 0.0;

  /// G over `most`.
  Mat3 scaled(std::size_t k) const { return bends[k].bend / most; }
};

Bends bends_of(const energy::FilmEnergy& energy, const Points& points,
               const Points& normals, int power) {
  const energy::FilmSpace& space = energy.space();
  Bends result{.facets = smooth_facets(energy)};
  result.bends.reserve(result.facets.size());
  for (const int f : result.facets) {
    const Triangle& t = energy.facets()[static_cast<std::size_t>(f)];
    std::array<Vec3, 3> n;
    for (int i = 0; i < 3; ++i) {
      n[i] = space.turn(f) * normals[space.first(t[i])];
    }
    result.bends.emplace_back(points, t, n);
    result.most = std::max(result.most, result.bends.back().bend.norm());
  }
  if (!(result.most > 0.0) || !std::isfinite(result.most)) {
    throw InvalidInput(
        "the film has no smallest radius: it is flat, or no facet lies away "
        "from its rims");
  }
  result.trace.reserve(result.bends.size());
  for (std::size_t k = 0; k < result.bends.size(); ++k) {
    const Mat3 g = result.scaled(k);
    const double area = 0.5 * result.bends[k].frame.area2;
    result.trace.push_back(power_of(g.transpose() * g, power / 2).trace());
    result.area += area;
    result.sum += area * result.trace.back();
  }
  return result;
}

}  // namespace

FilmResponse film_radius(const energy::FilmEnergy& energy, const Points& points,
                         int power) {
  if (power < kLeastPower || power > kMostPower || power % 2 != 0) {
    throw InvalidInput(
        fmt::format("the power of a smallest radius must be even, {} to {}, "
                    "found {}",
                    kLeastPower, kMostPower, power));
  }
  const energy::FilmSpace& space = energy.space();
  const Points normals = space.directions(points);
  const Bends all = bends_of(energy, points, normals, power);
  FilmResponse result;
  result.value = std::pow(all.sum / all.area, -1.0 / power) / all.most;
  result.by.points.assign(points.size(), Vec3::Zero());
  Points by_normals(normals.size(), Vec3::Zero());
  const double by_sum = -result.value / (power * all.sum);
  const double by_area = result.value / (power * all.area);
  for (std::size_t k = 0; k < all.bends.size(); ++k) {
    const FacetBend& b = all.bends[k];
    const Triangle& t =
        energy.facets()[static_cast<std::size_t>(all.facets[k])];
    const Mat3 g = all.scaled(k);
    const Mat3 by_bend = by_sum * 0.5 * b.frame.area2 * power / all.most * g *
                         power_of(g.transpose() * g, power / 2 - 1);
    std::array<Vec3, 3> by_normal;
    std::array<Vec3, 3> by_corner;
    by_normal.fill(Vec3::Zero());
    by_corner.fill(Vec3::Zero());
    b.transpose(by_bend, by_normal, by_corner);
    for (int i = 0; i < 3; ++i) {
      by_normals[space.first(t[i])] += space.turn(all.facets[k]) * by_normal[i];
      result.by.points[t[i]] +=
          by_corner[i] +
          (by_sum * all.trace[k] + by_area) * b.frame.area_gradient(i);
    }
  }
  space.transpose_directions(points, by_normals, result.by.points);
  return result;
}

}  // namespace meniscus::frozen
