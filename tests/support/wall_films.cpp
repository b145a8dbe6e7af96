#include "tests/support/wall_films.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/geometry/edge_key.h"
#include "tests/support/sheet_shapes.h"

namespace meniscus {

SurfaceMesh joined_films(const std::vector<SurfaceMesh>& films) {
  constexpr double kSamePoint = 1e-9;
  SurfaceMesh all;
  for (const SurfaceMesh& film : films) {
    std::vector<int> id;
    for (const Vec3& p : film.points) {
      std::size_t at = 0;
      while (at < all.points.size() &&
             (all.points[at] - p).norm() > kSamePoint) {
        ++at;
      }
      if (at == all.points.size()) {
        all.points.push_back(p);
      }
      id.push_back(static_cast<int>(at));
    }
    for (const Triangle& t : film.facets) {
      all.facets.push_back({id[t[0]], id[t[1]], id[t[2]]});
      all.facet_label.push_back(static_cast<int>(all.labels.size()));
    }
    all.labels.push_back(film.labels[0]);
  }
  return all;
}

SurfaceMesh film_fan(const std::vector<double>& angles, double rise, int n) {
  std::vector<SurfaceMesh> films;
  for (const double degree : angles) {
    const double a = degree * std::numbers::pi / 180.0;
    const Vec3 out(std::cos(a), 0.0, std::sin(a));
    const Vec3 up(-std::sin(a), 0.0, std::cos(a));
    films.push_back(shapes::patch(
        [&](double u, double v) -> Vec3 {
          return u * out + 2.0 * v * Vec3::UnitY() + rise * u * u * up;
        },
        {.rows = 2 * n, .columns = n, .jitter = 0.0},
        "film" + std::to_string(films.size())));
  }
  return joined_films(films);
}

walls::WallFilms wall_films_of(SurfaceMesh films, int levels,
                               double thickness) {
  walls::WallFilms input;
  input.wall.assign(films.labels.size(), 0);
  input.region = {0};
  input.asked = {thickness};
  input.levels = levels;
  Points& points = films.points;
  std::vector<Triangle> facets = films.facets;
  for (int level = 0; level < levels; ++level) {
    std::vector<Triangle> finer;
    for (const Triangle& t : facets) {
      Triangle m;
      for (int k = 0; k < 3; ++k) {
        const int a = t[k];
        const int b = t[(k + 1) % 3];
        const auto [at, fresh] = input.middles.try_emplace(
            edge_key(a, b), static_cast<int>(points.size()));
        if (fresh) {
          points.push_back(0.5 * (points[a] + points[b]));
        }
        m[k] = at->second;
      }
      finer.insert(finer.end(),
                   {Triangle{t[0], m[0], m[2]}, Triangle{t[1], m[1], m[0]},
                    Triangle{t[2], m[2], m[1]}, m});
    }
    facets = std::move(finer);
  }
  input.mesh = std::move(films);
  return input;
}

walls::ThickWall wall_of(const SurfaceMesh& films, double thickness,
                         int levels) {
  PlaceField field = Expression::parse("t", {"x", "y", "z", "t"});
  field.names = {"t"};
  field.numbers = VectorX::Constant(1, thickness);
  const walls::WallModel model(wall_films_of(films, levels, thickness),
                               {{.name = "web",
                                 .films = films.labels,
                                 .thickness = field,
                                 .side = walls::WallSide::Both,
                                 .fillet = std::nullopt,
                                 .region = 0}});
  return model.walls().at(0);
}

}  // namespace meniscus
