// Walls that end flush in the plane of a curve.
#include "evolve/walls/flush_ends.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/walls/wall_model.h"
#include "tests/support/sheet_shapes.h"

namespace meniscus::flush_ends_test {
namespace {

struct Cone {
  double bottom = 1.0;  // radii
  double top = 1.0;
  double height = 1.0;
  Mat3 turn = Mat3::Identity();
  Vec3 middle = Vec3::Zero();

  Vec3 at(double u, double v) const {
    const double angle = 2.0 * std::numbers::pi * u;
    const double r = (1.0 - v) * bottom + v * top;
    return middle +
           turn * Vec3(r * std::cos(angle), r * std::sin(angle), height * v);
  }
  Vec3 axis() const { return turn.col(2); }
  /// Between the cone and its ends' planes.
  double angle() const { return std::atan2(height, bottom - top); }
};

curves::Curve circle(const std::string& name, const Vec3& center,
                     const Vec3& axis, double radius) {
  return {.name = name,
          .shape = curves::Circle{
              .center = center, .normal = axis, .radius = radius}};
}

/// One film between circles "low" and "high".
walls::WallFilms films_of(const Cone& cone, int around, int rows) {
  walls::WallFilms films;
  films.mesh = shapes::patch(
      [&](double u, double v) { return cone.at(u, v); },
      {.rows = rows, .columns = around, .around = true, .jitter = 0.2});
  films.wall = {0};
  films.region = {0};
  films.asked = {0.1};
  const int last = static_cast<int>(films.mesh.points.size()) - around;
  walls::RimName low{.curve = "low", .films = {"web"}};
  walls::RimName high{.curve = "high", .films = {"web"}};
  for (int k = 0; k < around; ++k) {
    low.vertices.push_back(k);
    high.vertices.push_back(last + k);
  }
  films.names = {low, high};
  return films;
}

std::vector<curves::Curve> circles_of(const Cone& cone) {
  return {circle("low", cone.middle, cone.axis(), cone.bottom),
          circle("high", cone.middle + cone.height * cone.axis(), cone.axis(),
                 cone.top)};
}

walls::WallSpec wall(double thickness, std::vector<std::string> flush) {
  walls::WallSpec spec{.name = "web", .films = {"web"}};
  spec.thickness = Expression::parse("t", {"x", "y", "z", "t"});
  spec.thickness.names = {"t"};
  spec.thickness.numbers = VectorX::Constant(1, thickness);
  spec.flush = std::move(flush);
  return spec;
}

Cone random_cone(std::mt19937& random) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::normal_distribution<double> normal;
  Cone cone;
  cone.bottom = 1.0 + part(random);
  cone.top = cone.bottom * (0.6 + 0.8 * part(random));
  cone.height = 0.8 + part(random);
  cone.turn = Eigen::Quaterniond(normal(random), normal(random), normal(random),
                                 normal(random))
                  .normalized()
                  .toRotationMatrix();
  cone.middle = Vec3(normal(random), normal(random), normal(random));
  return cone;
}

/// Farthest a point of a label is off the plane through `at`.
double off_plane(const SurfaceMesh& mesh, const std::string& label,
                 const Vec3& at, const Vec3& normal, double& area) {
  double off = 0.0;
  area = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.labels[mesh.facet_label[f]] != label) {
      continue;
    }
    area += 0.5 * area_vector2(mesh, static_cast<int>(f)).norm();
    for (const int v : mesh.facets[f]) {
      off = std::max(off, std::abs((mesh.points[v] - at).dot(normal)));
    }
  }
  return off;
}

// An end is a ring of width t / sin a about the film's own circle.
TEST(FlushEnds, LieInTheirCurvesPlane) {
  constexpr int kAround = 72;
  std::mt19937 random(39);
  for (int k = 0; k < 12; ++k) {
    const Cone cone = random_cone(random);
    const double t = 0.04 + 0.01 * k;
    walls::WallFilms films = films_of(cone, kAround, 12);
    const std::vector<walls::WallSpec> specs = {wall(t, {"low"})};
    walls::add_flush_planes(circles_of(cone), specs, films);
    const walls::WallModel model(films, specs);
    const walls::ThickWall& made = model.walls().at(0);
    EXPECT_TRUE(made.findings.empty()) << summary(made.findings);
    double area = 0.0;
    EXPECT_LT(
        off_plane(made.surface, "web/rim:low", cone.middle, cone.axis(), area),
        1e-12);
    const double ring =
        2.0 * std::numbers::pi * cone.bottom * t / std::sin(cone.angle());
    EXPECT_NEAR(area, ring, 0.01 * ring);
    // The other end is square to its film, hence off its plane.
    const double square =
        off_plane(made.surface, "web/rim:high",
                  cone.middle + cone.height * cone.axis(), cone.axis(), area);
    EXPECT_NEAR(square, 0.5 * t * std::abs(std::cos(cone.angle())), 0.02 * t);
    EXPECT_GT(made.thinnest.value, 0.95 * t);
  }
}

TEST(FlushEnds, RefuseWhatHasNoPlane) {
  curves::Curve bent{
      .name = "bent",
      .shape = curves::Polygon{
          .points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.3}, {0, 1, 0}}}};
  EXPECT_THROW(walls::flush_normal(bent), InvalidInput);
  std::get<curves::Polygon>(bent.shape).points[2].z() = 0.0;
  EXPECT_NEAR(std::abs(walls::flush_normal(bent).z()), 1.0, 1e-12);
}

TEST(FlushEnds, RefuseFilmsInTheirPlane) {
  Cone nearly_flat{.bottom = 1.0, .top = 0.5, .height = 0.1};
  walls::WallFilms films = films_of(nearly_flat, 24, 6);
  EXPECT_THROW(walls::add_flush_planes(circles_of(nearly_flat),
                                       {wall(0.05, {"low"})}, films),
               InvalidInput);
  walls::add_flush_planes(circles_of(nearly_flat), {wall(0.05, {})}, films);
  EXPECT_TRUE(films.planes.planes.empty());
}

}  // namespace
}  // namespace meniscus::flush_ends_test
