#include "cad/solid/measure_solid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace meniscus::solid {

namespace {

constexpr int kPerSpan = 3;

/// Distance from `p` to the surface, by Gauss-Newton from about its foot; `at`
/// becomes the foot.
double distance_to(const SplineSurface& surface, const Vec3& p, Vec2& at) {
  double best = (jet_of(surface, at).point - p).norm();
  for (int round = 0; round < 10; ++round) {
    const SurfaceJet jet = jet_of(surface, at);
    Eigen::Matrix<double, 3, 2> slopes;
    slopes << jet.by_a, jet.by_b;
    const Eigen::Matrix2d normal = slopes.transpose() * slopes;
    at += normal.inverse() * (slopes.transpose() * (p - jet.point));
    at = at.cwiseMax(0.0).cwiseMin(1.0);
    best = std::min(best, (jet_of(surface, at).point - p).norm());
  }
  return best;
}

/// The same from the nearest of some points of the surface.
double distance_to(const SplineSurface& surface, const Vec3& p) {
  constexpr int kGrid = 12;
  Vec2 start = Vec2::Zero();
  double nearest = -1.0;
  for (int k = 0; k <= kGrid * (kGrid + 2); ++k) {
    const int row = k / (kGrid + 1);
    const int column = k % (kGrid + 1);
    const Vec2 at(static_cast<double>(row) / kGrid,
                  static_cast<double>(column) / kGrid);
    const double distance = (jet_of(surface, at).point - p).norm();
    if (nearest < 0.0 || distance < nearest) {
      nearest = distance;
      start = at;
    }
  }
  return distance_to(surface, p, start);
}

/// Distance of the film's vertex that one patch has; beside its side it may lie
/// on another.
double distance_of(const FilmFaces& faces, std::size_t patch, const Vec3& p,
                   Vec2 at) {
  double best = distance_to(faces.patches[patch].surface, p, at);
  const bool at_side = (at.array() == 0.0).any() || (at.array() == 1.0).any();
  for (std::size_t q = 0; q < faces.patches.size() && at_side; ++q) {
    if (q != patch) {
      best = std::min(best, distance_to(faces.patches[q].surface, p));
    }
  }
  return best;
}

std::vector<double> places_in(const std::vector<double>& knots) {
  std::vector<double> result;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    for (int i = 0; i < kPerSpan && knots[k + 1] > knots[k]; ++i) {
      result.push_back(knots[k] +
                       (knots[k + 1] - knots[k]) * (i + 0.5) / kPerSpan);
    }
  }
  return result;
}

/// Where the farthest of both ways is, before it is counted.
void note_place(FilmSolidReport& report, const std::string& film,
                const Vec3& place, double off) {
  if (off > std::max(report.film_to_solid, report.solid_to_film)) {
    report.off_film = film;
    report.off_place = place;
  }
}

/// From the surface along its normal to the facets, either way. `part_of`: 0
/// for every facet.
void measure_samples(const SplineSurface& surface, const std::string& film,
                     const FacetTree& tree, const std::vector<int>& part_of,
                     double edge, FilmSolidReport& report) {
  for (const double a : places_in(surface.knots_a)) {
    for (const double b : places_in(surface.knots_b)) {
      const SurfaceJet jet = jet_of(surface, {a, b});
      const Vec3 normal = jet.by_a.cross(jet.by_b).normalized();
      const Vec3 above = jet.point + edge * normal;
      const auto hit = tree.first_hit(above, -normal, part_of, -1);
      if (hit && hit->distance < 2.0 * edge) {
        const double off = std::abs(hit->distance - edge);
        note_place(report, film, jet.point, off);
        report.solid_to_film = std::max(report.solid_to_film, off);
      }
    }
  }
}

void measure_breaks(const FilmPiece& film, const FilmFaces& faces,
                    FilmSolidReport& report) {
  struct Use {
    int patch;
    int side;
  };
  std::map<int, std::vector<Use>> uses;
  const std::vector<FilmPatch>& patches = film.cut.patches;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    for (int side = 0; side < 4; ++side) {
      if (patches[p].lines[side] >= 0) {
        uses[patches[p].lines[side]].push_back({static_cast<int>(p), side});
      }
    }
  }
  const auto jet_at = [&](const Use& use, double t) {
    const bool back = patches[use.patch].reversed[use.side];
    return jet_of(faces.patches[use.patch].surface,
                  on_side(use.side, back ? 1.0 - t : t));
  };
  for (const auto& [line, both] : uses) {
    constexpr int kSamples = 100;
    for (int k = 0; k <= kSamples && both.size() == 2; ++k) {
      const double t = static_cast<double>(k) / kSamples;
      const SurfaceJet p = jet_at(both[0], t);
      const SurfaceJet q = jet_at(both[1], t);
      const Vec3 m = p.by_a.cross(p.by_b);
      const Vec3 n = q.by_a.cross(q.by_b);
      const double angle =
          std::atan2(m.cross(n).norm(), m.dot(n)) * 180.0 / std::numbers::pi;
      if (angle > report.tangent_break) {
        report.tangent_break = angle;
        report.break_film = film.name;
        report.break_place = p.point;
      }
    }
  }
}

}  // namespace

void measure_film(const FilmPiece& film, const FilmFaces& faces,
                  const FacetTree& tree, double edge, FilmSolidReport& report) {
  const int most = *std::max_element(film.facets.begin(), film.facets.end());
  const std::vector<int> part_of(most + 1, 0);
  for (std::size_t p = 0; p < faces.patches.size(); ++p) {
    const FittedPatch& patch = faces.patches[p];
    for (std::size_t k = 0; k < patch.vertices.size(); ++k) {
      const Vec3& place = film.cut.mesh.points[patch.vertices[k]];
      const double off = distance_of(faces, p, place, patch.at[k]);
      note_place(report, film.name, place, off);
      report.film_to_solid = std::max(report.film_to_solid, off);
    }
    measure_samples(patch.surface, film.name, tree, part_of, edge, report);
  }
  measure_breaks(film, faces, report);
}

}  // namespace meniscus::solid
