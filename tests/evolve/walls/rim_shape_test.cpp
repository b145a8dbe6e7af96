// Shapes of thickness on a wall's own harmonic coordinates.
#include "evolve/walls/rim_shape.h"

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"

namespace meniscus::rim_shape_test {
namespace {

using testing::HasSubstr;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kSame = 1e-12;  // rounding

/// A cone's frustum around z between z = 0 and `height`, its rims "foot" and
/// "head" at random t in order; inner vertices are shaken along it.
struct Cone {
  double foot = 1.0;
  double head = 1.0;
  double height = 2.0;
  int around = 24;
  double start = 0.0;      // angle of the foot's t = 0 [turns]
  bool clockwise = false;  // the foot's t
  unsigned seed = 1;
  double shake = 0.1;  // of the edges
};

struct Film {
  SurfaceMesh mesh;
  std::vector<walls::WallRim> rims;
};

Film film_of(const Cone& cone) {
  std::mt19937 random(cone.seed);
  std::uniform_real_distribution<double> shake(-cone.shake, cone.shake);
  Film film;
  const double slant = std::hypot(cone.height, cone.foot - cone.head);
  const double radius = 0.5 * (cone.foot + cone.head);
  const int n = cone.around;
  const int rows =
      std::max(2, static_cast<int>(std::lround(slant / (kTurn * radius / n))));
  film.rims = {{"foot", {}, {}}, {"head", {}, {}}};
  for (int row = 0; row <= rows; ++row) {
    const bool is_rim = row == 0 || row == rows;
    for (int k = 0; k < n; ++k) {
      const double turns = (k + 0.5 * (row % 2) + shake(random)) / n;
      const double s = (row + (is_rim ? 0.0 : shake(random))) / rows;
      const double r = cone.foot + s * (cone.head - cone.foot);
      film.mesh.points.emplace_back(r * std::cos(kTurn * turns),
                                    r * std::sin(kTurn * turns),
                                    s * cone.height);
      if (is_rim) {
        walls::WallRim& rim = film.rims[row == 0 ? 0 : 1];
        double t = (turns - cone.start) * (cone.clockwise ? -1.0 : 1.0);
        t -= std::floor(t);
        rim.vertices.push_back(row * n + k);
        rim.t.push_back(t);
      }
    }
  }
  for (int row = 0; row < rows; ++row) {
    for (int k = 0; k < n; ++k) {
      const int next = (k + 1) % n;
      const int a = row * n + k;
      const int b = row * n + next;
      const int c = (row + 1) * n + k;
      const int d = (row + 1) * n + next;
      if (row % 2 == 0) {
        film.mesh.facets.push_back({a, b, c});
        film.mesh.facets.push_back({b, d, c});
      } else {
        film.mesh.facets.push_back({a, b, d});
        film.mesh.facets.push_back({a, d, c});
      }
    }
  }
  film.mesh.facet_label.assign(film.mesh.facets.size(), 0);
  film.mesh.labels = {"skin"};
  return film;
}

/// A wall of the one film whose thickness is the shape alone.
walls::WallSpec wall_of(const walls::RimSplines& splines,
                        const VectorX& coefficients) {
  walls::WallSpec wall;
  wall.name = "shell";
  wall.films = {"skin"};
  wall.thickness = PlaceField(Expression::parse("s", {"x", "y", "z", "s"}));
  wall.thickness.shapes = {walls::rim_splines(splines)};
  wall.thickness.numbers = coefficients;
  return wall;
}

PlaceField laid_on(const Film& film, const walls::WallSpec& wall) {
  return walls::on_films({wall}, film.mesh, {0}, film.rims)[0].thickness;
}

VectorX drawn(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(1.0, 3.0);
  VectorX result(count);
  for (double& c : result) {
    c = value(random);
  }
  return result;
}

/// The largest distance to the same splines over the cone's exact coordinates:
/// its angle, and the logarithm of its distance from the apex.
double error_of(const Cone& cone, const Film& film) {
  const VectorX c = drawn(4 * 5, 11);
  const PlaceField field = laid_on(film, wall_of({"foot", "head", 4, 5}, c));
  const auto exact = axis_splines({.along = 4, .around = 5});
  double worst = 0.0;
  for (const Vec3& p : film.mesh.points) {
    const double r = std::hypot(p.x(), p.y());
    const double u =
        cone.foot == cone.head
            ? p.z() / cone.height
            : std::log(r / cone.foot) / std::log(cone.head / cone.foot);
    const double angle = (std::atan2(p.y(), p.x()) - kTurn * cone.start) *
                         (cone.clockwise ? -1.0 : 1.0);
    const Vec3 place(std::cos(angle), std::sin(angle), u);
    const double value =
        exact->jet(place, {c.data(), static_cast<std::size_t>(c.size())}).value;
    worst = std::max(worst, std::abs(value_at(field, field.own(), p) - value));
  }
  return worst;
}

TEST(RimShape, FollowsTheCoordinatesOfCones) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (int draw = 0; draw < 6; ++draw) {
    Cone cone{.foot = 0.6 + part(random),
              .head = draw == 0 ? 1.0 : 0.5 + part(random),
              .height = 1.0 + 2.0 * part(random),
              .start = part(random),
              .clockwise = draw % 2 == 1,
              .seed = static_cast<unsigned>(draw)};
    if (draw == 0) {
      cone.foot = 1.0;
    }
    const double coarse = error_of(cone, film_of(cone));
    cone.around *= 4;
    const double fine = error_of(cone, film_of(cone));
    EXPECT_LT(coarse, 0.02) << draw;
    EXPECT_LT(fine, coarse / 8.0) << draw;
  }
}

/// What the same splines about an axis have at height u.
double at_height(const VectorX& c, double u) {
  return axis_splines({.along = static_cast<int>(c.size())})
      ->jet({1, 0, u}, {c.data(), static_cast<std::size_t>(c.size())})
      .value;
}

/// Every facet in four, new points on the cone, t of new rim points between.
Film refined(const Film& film, const Cone& cone) {
  Film result = film;
  result.mesh.facets.clear();
  std::map<Edge, int> middle;
  std::map<int, double> t_of;  // of either rim's points
  for (const walls::WallRim& rim : film.rims) {
    for (std::size_t k = 0; k < rim.vertices.size(); ++k) {
      t_of[rim.vertices[k]] = rim.t[k];
    }
  }
  const auto middle_of = [&](int a, int b) {
    const auto [at, is_new] =
        middle.try_emplace(edge_key(a, b), std::ssize(result.mesh.points));
    if (!is_new) {
      return at->second;
    }
    Vec3 p = 0.5 * (film.mesh.points[a] + film.mesh.points[b]);
    const double r = cone.foot + p.z() / cone.height * (cone.head - cone.foot);
    p.head<2>() *= r / p.head<2>().norm();
    result.mesh.points.push_back(p);
    for (int end = 0; end < 2; ++end) {
      if (p.z() == (end == 0 ? 0.0 : cone.height)) {
        double t = std::atan2(p.y(), p.x()) / kTurn - cone.start;
        t *= cone.clockwise ? -1.0 : 1.0;
        result.rims[end].vertices.push_back(at->second);
        result.rims[end].t.push_back(t - std::floor(t));
      }
    }
    return at->second;
  };
  for (const Triangle& t : film.mesh.facets) {
    const Triangle m = {middle_of(t[0], t[1]), middle_of(t[1], t[2]),
                        middle_of(t[2], t[0])};
    result.mesh.facets.push_back({t[0], m[0], m[2]});
    result.mesh.facets.push_back({t[1], m[1], m[0]});
    result.mesh.facets.push_back({t[2], m[2], m[1]});
    result.mesh.facets.push_back(m);
  }
  result.mesh.facet_label.assign(result.mesh.facets.size(), 0);
  return result;
}

// Halves of obtuse facets are no Delaunay mesh: weights held above 0 would keep
// their error on all levels.
TEST(RimShape, FollowsThemOnNestedRefinements) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Cone cone{.foot = 1.2,
                    .head = 0.7,
                    .start = 0.1,
                    .clockwise = seed == 2,
                    .seed = seed,
                    .shake = 0.3};
    Film film = film_of(cone);
    std::vector<double> errors = {error_of(cone, film)};
    for (int level = 0; level < 3; ++level) {
      film = refined(film, cone);
      errors.push_back(error_of(cone, film));
    }
    EXPECT_LT(errors[0], 5e-3) << seed;
    EXPECT_LT(errors[3], errors[0] / 16.0) << seed;
  }
}

TEST(RimShape, BeginsTowardsItsZero) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (int draw = 0; draw < 8; ++draw) {
    Cone cone{.foot = 1.1,
              .head = 0.9,
              .around = 96,
              .start = part(random),  // of t, which does not count
              .clockwise = draw % 2 == 1,
              .seed = static_cast<unsigned>(draw)};
    const Film film = film_of(cone);
    const double zero = kTurn * part(random);
    const VectorX c = drawn(5, 7);
    const PlaceField field = laid_on(
        film, wall_of({.first = "foot",
                       .second = "head",
                       .around = 5,
                       .zero = 3.0 * Vec3(std::cos(zero), std::sin(zero), 0.4)},
                      c));
    const auto exact = axis_splines({.around = 5});
    for (const Vec3& p : film.mesh.points) {
      const double angle =
          (std::atan2(p.y(), p.x()) - zero) * (cone.clockwise ? -1.0 : 1.0);
      EXPECT_NEAR(
          value_at(field, field.own(), p),
          exact->jet({std::cos(angle), std::sin(angle), 0.0}, {c.data(), 5})
              .value,
          5e-3)
          << draw;
    }
  }
  const Film film = film_of({});
  EXPECT_THROW(laid_on(film, wall_of({.first = "foot",
                                      .second = "head",
                                      .around = 2,
                                      .zero = Vec3::UnitZ()},
                                     drawn(2, 1))),
               InvalidInput);
}

TEST(RimShape, RunsFromTheFirstCurveToTheSecond) {
  const Film film = film_of({.foot = 1.3, .head = 0.8});
  const VectorX c = drawn(4, 3);
  for (const bool turned : {false, true}) {
    const PlaceField field = laid_on(
        film,
        wall_of({turned ? "head" : "foot", turned ? "foot" : "head", 4, 1}, c));
    for (int end = 0; end < 2; ++end) {
      for (const int v : film.rims[end].vertices) {
        EXPECT_NEAR(value_at(field, field.own(), film.mesh.points[v]),
                    at_height(c, (end == 0) != turned ? 0.0 : 1.0), kSame);
      }
    }
  }
}

TEST(RimShape, StaysBetweenItsCoefficientsAndIsTheirsByNumbers) {
  const Film film = film_of({.foot = 1.3, .head = 0.7, .start = 0.3});
  const VectorX c = drawn(3 * 4, 8);
  const walls::WallSpec wall = wall_of({"foot", "head", 3, 4}, c);
  const PlaceField field = laid_on(film, wall);
  const VectorX rates = drawn(3 * 4, 9);
  const VectorX moved = c + rates;
  for (const Vec3& p : film.mesh.points) {
    const double value = value_at(field, field.own(), p);
    EXPECT_GE(value, c.minCoeff() - kSame);
    EXPECT_LE(value, c.maxCoeff() + kSame);
    // Linear in the coefficients, and its transpose.
    VectorX by = VectorX::Zero(c.size());
    add_by_numbers(field, field.own(), p, 1.0, Vec3::Zero(), by);
    EXPECT_NEAR(by.dot(rates), value_at(field, {moved.data(), 12}, p) - value,
                1e-9);
    EXPECT_NEAR(by.sum(), 1.0, kSame);
  }
}

TEST(RimShape, FromOneRimToAnotherOfSeveralFilms) {
  // The second film goes on from the head: the coordinate passes through both.
  Film film = film_of({.foot = 1.0, .head = 1.0, .height = 1.0});
  const Film other = film_of({.foot = 1.0, .head = 1.0, .height = 1.0});
  const auto first = static_cast<int>(film.mesh.points.size());
  const int below = film.rims[1].vertices.front();
  for (const Vec3& p : other.mesh.points) {
    film.mesh.points.emplace_back(p.x(), p.y(), p.z() + 1.0);
  }
  for (Triangle t : other.mesh.facets) {
    for (int& v : t) {
      v = v < 24 ? below + v : first + v;
    }
    film.mesh.facets.push_back(t);
    film.mesh.facet_label.push_back(1);
  }
  film.mesh.labels.emplace_back("top");
  film.rims.push_back({"tip", {}, other.rims[1].t});
  for (const int v : other.rims[1].vertices) {
    film.rims.back().vertices.push_back(first + v);
  }
  const VectorX c = drawn(3, 4);
  const PlaceField field = walls::on_films({wall_of({"foot", "tip", 3, 1}, c)},
                                           film.mesh, {0, 0}, film.rims)[0]
                               .thickness;
  EXPECT_NEAR(value_at(field, field.own(), film.mesh.points[0]),
              at_height(c, 0.0), kSame);
  EXPECT_NEAR(value_at(field, field.own(), film.mesh.points.back()),
              at_height(c, 1.0), kSame);
  // Halfway by symmetry.
  EXPECT_NEAR(value_at(field, field.own(), film.mesh.points[below]),
              at_height(c, 0.5), 0.02);
}

TEST(RimShape, PassesOtherRims) {
  // A window in the side: no flux through it, so heights beside it are those
  // of a tube without, and the angle goes around all the same.
  const Film whole = film_of({.around = 48});
  Film film = whole;
  film.mesh.facets.clear();
  for (const Triangle& t : whole.mesh.facets) {
    const Vec3 middle = (whole.mesh.points[t[0]] + whole.mesh.points[t[1]] +
                         whole.mesh.points[t[2]]) /
                        3.0;
    if ((middle - Vec3(1, 0, 1)).norm() > 0.5) {
      film.mesh.facets.push_back(t);
    }
  }
  ASSERT_LT(film.mesh.facets.size(), whole.mesh.facets.size());
  film.mesh.facet_label.assign(film.mesh.facets.size(), 0);
  VectorX c = VectorX::Constant(9, 1.0);
  c.tail(3).setConstant(2.0);  // 3 along, 3 around: up from the foot
  const walls::WallSpec along = wall_of({"foot", "head", 3, 3}, c);
  const PlaceField field = laid_on(film, along);
  const PlaceField open = laid_on(whole, along);
  double most = 0.0;
  for (const Triangle& t : film.mesh.facets) {
    for (const int v : t) {
      const Vec3& p = film.mesh.points[v];
      const double value = value_at(field, field.own(), p);
      EXPECT_GE(value, 1.0 - kSame);
      EXPECT_LE(value, 2.0 + kSame);
      const double apart = std::abs(value - value_at(open, open.own(), p));
      if (p.z() == 0.0 || p.z() == 2.0) {
        EXPECT_LT(apart, kSame);
      }
      most = std::max(most, apart);
    }
  }
  // Beside a window of radius a the height is off by up to a / length, as the
  // potential about a hole in a plane: a quarter here.
  EXPECT_GT(most, 0.1);
  EXPECT_LT(most, 0.3);
  // One bump around moves half of the tube, not all.
  c = VectorX::Constant(2, 1.0);
  c[1] = 2.0;
  const PlaceField turn = laid_on(film, wall_of({"foot", "head", 1, 2}, c));
  EXPECT_NEAR(value_at(turn, turn.own(), film.mesh.points[0]) +
                  value_at(turn, turn.own(), film.mesh.points[24]),
              3.0, 0.05);
}

TEST(RimShape, RefusesWhatHasNoSuchCoordinates) {
  EXPECT_THROW(walls::rim_splines({"foot", "foot", 2, 1}), InvalidInput);
  EXPECT_THROW(walls::rim_splines({"foot", "head", 0, 1}), InvalidInput);
  const Film film = film_of({});
  const VectorX c = drawn(4, 4);
  EXPECT_THAT(
      [&] {
        laid_on(film, wall_of({"foot", "waist", 4, 1}, c));
      },
      testing::ThrowsMessage<InvalidInput>(
          HasSubstr("walls.shell: thickness \"s\": its films do not end at "
                    "curve 'waist'")));
  // Parts that a curve is not the end of; several films around.
  Film two = film;
  const auto shift = static_cast<int>(film.mesh.points.size());
  for (const Vec3& p : film.mesh.points) {
    two.mesh.points.emplace_back(p.x() + 9.0, p.y(), p.z());
  }
  for (const Triangle& t : film.mesh.facets) {
    two.mesh.facets.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    two.mesh.facet_label.push_back(1);
  }
  two.mesh.labels = {"skin", "other"};
  const auto lay_two = [&](int around) {
    walls::on_films({wall_of({"foot", "head", 4 / around, around}, c)},
                    two.mesh, {0, 0}, two.rims);
  };
  EXPECT_THAT([&] { lay_two(1); },
              testing::ThrowsMessage<InvalidInput>(
                  HasSubstr("do not all reach curve 'foot': give film 'other' "
                            "a wall of its own")));
  for (std::size_t k = 0; k < 2; ++k) {
    walls::WallRim& rim = two.rims[k];
    for (std::size_t i = 0; i < film.rims[k].vertices.size(); ++i) {
      rim.vertices.push_back(film.rims[k].vertices[i] + shift);
      rim.t.push_back(film.rims[k].t[i]);
    }
  }
  EXPECT_NO_THROW(lay_two(1));
  EXPECT_THAT([&] { lay_two(2); }, testing::ThrowsMessage<InvalidInput>(
                                       HasSubstr("is for a wall of one film")));
  two.rims[0].t.clear();
  EXPECT_THROW(lay_two(1), InvalidInput);
  // Not yet on a film: no value.
  const walls::WallSpec wall = wall_of({"foot", "head", 4, 1}, c);
  EXPECT_THROW(
      value_at(wall.thickness, wall.thickness.own(), film.mesh.points[0]),
      ExpressionError);
  // Beside the film: neither.
  const PlaceField field = laid_on(film, wall);
  EXPECT_THROW(value_at(field, field.own(), {0, 0, 0.5}), ExpressionError);
  // A quarter of the tube is none.
  Film strip = film;
  strip.mesh.facets.clear();
  for (std::size_t f = 0; f < film.mesh.facets.size(); ++f) {
    const Triangle& t = film.mesh.facets[f];
    const Vec3 middle = film.mesh.points[t[0]] + film.mesh.points[t[1]] +
                        film.mesh.points[t[2]];
    if (middle.x() > 0.0 && middle.y() > 0.0) {
      strip.mesh.facets.push_back(t);
    }
  }
  strip.mesh.facet_label.assign(strip.mesh.facets.size(), 0);
  EXPECT_NO_THROW(laid_on(strip, wall));
  EXPECT_THAT(
      [&] {
        laid_on(strip, wall_of({"foot", "head", 2, 2}, c));
      },
      testing::ThrowsMessage<InvalidInput>(
          HasSubstr("make no tube from curve 'foot' to 'head'")));
}

}  // namespace
}  // namespace meniscus::rim_shape_test
