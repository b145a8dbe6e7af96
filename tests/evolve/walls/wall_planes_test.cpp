// Walls that end in planes: there to rounding, as thick as asked beside them,
// and a smooth map of their films.
#include "evolve/walls/wall_planes.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/geometry/mesh_checks.h"
#include "evolve/walls/wall_model.h"
#include "tests/support/sheet_shapes.h"

namespace meniscus::wall_planes_test {
namespace {

constexpr double kPlaneRounding = 1e-12;
constexpr double kPlaneDifference = 1e-7;  // central differences, step 1e-6

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  Vec3 vector() { return {number(), number(), number()}; }
  Vec3 unit() { return vector().normalized(); }

 private:
  double number() { return normal_(engine_); }
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

walls::WallPlanes planes_of_one_point(const std::vector<Vec3>& normals) {
  walls::WallPlanes planes;
  planes.at.resize(1);
  for (const Vec3& normal : normals) {
    planes.at[0].push_back(static_cast<int>(planes.planes.size()));
    planes.planes.push_back({normal, "rim"});
  }
  return planes;
}

TEST(WallPlanes, KeepTheDistanceFromTheTangentPlane) {
  Draw draw(7);
  for (int k = 0; k < 50; ++k) {
    std::vector<Vec3> normals = {draw.unit()};
    if (k % 2 == 1) {
      normals.push_back(draw.unit());
    }
    const Mat3 along = *planes_of_one_point(normals).along(0);
    const Vec3 n = draw.unit();
    const Vec3 w = draw.vector();
    const Vec3 d = walls::in_planes(along, n, w);
    for (const Vec3& normal : normals) {
      EXPECT_NEAR(normal.dot(d), 0.0, 1e-9 * d.norm());
    }
    EXPECT_NEAR(n.dot(d), n.dot(w), 1e-9 * (1.0 + d.norm()));
    // What lies in the planes already stays.
    EXPECT_NEAR((walls::in_planes(along, n, d) - d).norm(), 0.0,
                1e-9 * (1.0 + d.norm()));
  }
  EXPECT_FALSE(planes_of_one_point({}).along(0).has_value());
  EXPECT_FALSE(walls::WallPlanes().along(3).has_value());
}

TEST(WallPlanes, AreTransposed) {
  Draw draw(11);
  for (int k = 0; k < 20; ++k) {
    const Mat3 along =
        *planes_of_one_point(k % 2 == 0
                                 ? std::vector<Vec3>{draw.unit()}
                                 : std::vector<Vec3>{draw.unit(), draw.unit()})
             .along(0);
    const Vec3 n = draw.unit();
    if ((along * n).norm() < 0.3) {
      continue;  // differences would need finer steps
    }
    const Vec3 w = draw.vector();
    const Vec3 by = draw.vector();
    const Vec3 rate_n = draw.vector();
    const Vec3 rate_w = draw.vector();
    const walls::InPlanesGradient gradient =
        walls::transpose_in_planes(along, n, w, by);
    const double step = 1e-6;
    const auto value = [&](double s) {
      return by.dot(walls::in_planes(along, n + s * rate_n, w + s * rate_w));
    };
    const double exact = gradient.normal.dot(rate_n) + gradient.w.dot(rate_w);
    EXPECT_NEAR(exact, (value(step) - value(-step)) / (2.0 * step),
                1e-7 * (1.0 + std::abs(exact)));
  }
}

/// A strip that rises from z = 0 at an angle, between the planes x = 0 and
/// x = 1, on both of which it slides, too.
walls::WallFilms strip(double angle) {
  walls::WallFilms films;
  films.mesh = shapes::patch(
      [&](double u, double v) {
        return Vec3(u, v * std::cos(angle), v * std::sin(angle));
      },
      {.rows = 12, .columns = 12, .jitter = 0.2});
  films.wall = {0};
  films.region = {0};
  films.asked = {0.1};
  films.planes.planes = {{Vec3::UnitZ(), "rim:floor"},
                         {Vec3::UnitX(), "symmetry_1"},
                         {-Vec3::UnitX(), "symmetry_2"}};
  for (const Vec3& p : films.mesh.points) {
    std::vector<int>& at = films.planes.at.emplace_back();
    for (const auto& [plane, off] :
         {std::pair(0, p.z()), std::pair(1, p.x()), std::pair(2, p.x() - 1)}) {
      if (std::abs(off) < 1e-12) {
        at.push_back(plane);
      }
    }
  }
  return films;
}

std::vector<walls::WallSpec> specs_of(const walls::WallFilms& films,
                                      double thickness) {
  walls::WallSpec spec{.name = "web", .films = films.mesh.labels};
  spec.thickness = Expression::parse("t", {"x", "y", "z", "t"});
  spec.thickness.names = {"t"};
  spec.thickness.numbers = VectorX::Constant(1, thickness);
  return {spec};
}

// The strip's area times its thickness: what an end has more on one side it has
// less on the other. A wall of 0.3 is wider than three facets.
TEST(WallPlanes, CutAStripAslant) {
  for (const double degrees : {60.0, 75.0, 90.0, 105.0, 120.0}) {
    for (const double thickness : {0.05, 0.3}) {
      const double angle = degrees * EIGEN_PI / 180.0;
      const walls::WallFilms films = strip(angle);
      const walls::WallModel model(films, specs_of(films, thickness));
      const walls::ThickWall& wall = model.walls().at(0);
      EXPECT_TRUE(wall.findings.empty()) << summary(wall.findings);
      EXPECT_NEAR(wall.volume, thickness, kPlaneRounding);
      EXPECT_NEAR(wall.thinnest.value, thickness, 1e-9);
      EXPECT_NEAR(wall.thickest.value, thickness, 1e-9);
      const SurfaceMesh& mesh = wall.surface;
      double lowest = 1.0;
      double width = 0.0;  // of the end, its area over the strip's width
      for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        const std::string& label = mesh.labels[mesh.facet_label[f]];
        for (const int v : mesh.facets[f]) {
          lowest = std::min(lowest, mesh.points[v].z());
          if (label == "web/rim:floor") {
            EXPECT_NEAR(mesh.points[v].z(), 0.0, kPlaneRounding);
          } else if (label == "web/symmetry_1") {
            EXPECT_NEAR(mesh.points[v].x(), 0.0, kPlaneRounding);
          }
        }
        if (label == "web/rim:floor") {
          width += area_vector2(mesh, static_cast<int>(f)).norm() / 2.0;
        }
      }
      EXPECT_NEAR(lowest, 0.0, kPlaneRounding);
      EXPECT_NEAR(width, thickness / std::sin(angle), 1e-9);
    }
  }
}

TEST(WallPlanes, WallsInThemFollowTheirFilms) {
  const walls::WallFilms films = strip(1.1);
  const std::vector<walls::WallSpec> specs = specs_of(films, 0.1);
  const walls::WallModel model(films, specs);
  const std::vector<VectorX> numbers = {1.3 * specs[0].thickness.numbers};
  Draw draw(3);
  Points film = films.mesh.points;
  Points rate(film.size());
  for (std::size_t v = 0; v < film.size(); ++v) {
    const Mat3 along =
        films.planes.along(static_cast<int>(v)).value_or(Mat3::Identity());
    film[v] += along * (0.005 * draw.vector());
    rate[v] = along * draw.vector();
  }
  const QuadraticSurface there = model.surface(film, numbers);
  Points by_corners;
  Points by_mid;
  for (std::size_t i = 0; i < there.base.points.size(); ++i) {
    by_corners.push_back(draw.vector());
  }
  for (std::size_t i = 0; i < there.mid.size(); ++i) {
    by_mid.push_back(draw.vector());
  }
  const auto objective = [&](double step) {
    Points at = film;
    for (std::size_t v = 0; v < at.size(); ++v) {
      at[v] += step * rate[v];
    }
    const QuadraticSurface s =
        model.surface(at, {numbers[0] + VectorX::Constant(1, step)});
    double sum = 0.0;
    for (std::size_t i = 0; i < by_corners.size(); ++i) {
      sum += by_corners[i].dot(s.base.points[i]);
    }
    for (std::size_t i = 0; i < by_mid.size(); ++i) {
      sum += by_mid[i].dot(s.mid[i]);
    }
    return sum;
  };
  const walls::WallGradient gradient =
      model.transpose(film, numbers, by_corners, by_mid);
  double exact = gradient.thickness[0][0];
  for (std::size_t v = 0; v < film.size(); ++v) {
    exact += gradient.film[v].dot(rate[v]);
  }
  const double step = 1e-6;
  const double found = (objective(step) - objective(-step)) / (2.0 * step);
  EXPECT_NEAR(exact, found, kPlaneDifference * std::abs(found) + 1e-7);
  // The ends stay in the plane.
  for (std::size_t f = 0; f < there.base.facets.size(); ++f) {
    if (there.base.labels[there.base.facet_label[f]] == "web/rim:floor") {
      for (const int v : there.base.facets[f]) {
        EXPECT_NEAR(there.base.points[v].z(), 0.0, kPlaneRounding);
      }
    }
  }
}

}  // namespace
}  // namespace meniscus::wall_planes_test
