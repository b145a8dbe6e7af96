// Fillets on surfaces of revolution: the arc of a rolling ball, its volume, and
// a smooth map of the surface and the radius.
#include "evolve/fillets/fillet_model.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus::fillet_model_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kRadius = 10.0;  // of the film
constexpr double kBall = 2.0;
/// Of the section between an arc of a quarter turn and its corner, by r^2, and
/// of its middle's distance from either leg, by r.
constexpr double kArea = 1.0 - kHalfTurn / 4.0;
const double kMiddle = (10.0 - 3.0 * kHalfTurn) / (3.0 * (4.0 - kHalfTurn));
constexpr double kDifferenceStep = 1e-5;
constexpr double kDifferenceError = 1e-7;  // of steps squared, and rounding
constexpr double kTorusRounding = 1e-11;   // of some hundred sums
constexpr double kLeastOrder = 1.8;        // of chords: 2

/// A surface of revolution about z, its sections (radius, z) at equal steps.
struct Turned {
  std::string label;
  std::function<Vec3(double)> section;  // of (0, 1): radius, 0, z
};

struct Shape {
  SurfaceMesh mesh;
  std::vector<int> rim;
};

/// Two of them from a rim that they share, the second turned over. `n` rows
/// each, `around` facets; vertices moved by `bent`.
Shape turned(const Turned& film, const Turned& face, int n, int around,
             const std::function<Vec3(Vec3)>& bent = {}) {
  Shape shape;
  const auto add = [&](const Turned& part, bool over) {
    const int label = static_cast<int>(shape.mesh.labels.size());
    shape.mesh.labels.push_back(part.label);
    const int first = static_cast<int>(shape.mesh.points.size());
    for (int row = label == 0 ? 0 : 1; row <= n; ++row) {
      const Vec3 at = part.section(static_cast<double>(row) / n);
      for (int k = 0; k < around; ++k) {
        const double turn = 2.0 * kHalfTurn * k / around;
        const Vec3 p(at.x() * std::cos(turn), at.x() * std::sin(turn), at.z());
        shape.mesh.points.push_back(bent ? bent(p) : p);
      }
    }
    const auto id = [&](int row, int k) {
      return row == 0
                 ? k % around
                 : first + (label == 0 ? row : row - 1) * around + k % around;
    };
    for (int row = 0; row < n; ++row) {
      for (int k = 0; k < around; ++k) {
        Triangle one = {id(row, k), id(row, k + 1), id(row + 1, k + 1)};
        Triangle two = {id(row, k), id(row + 1, k + 1), id(row + 1, k)};
        for (Triangle* t : {&one, &two}) {
          if (over) {
            std::swap((*t)[1], (*t)[2]);
          }
          shape.mesh.facets.push_back(*t);
          shape.mesh.facet_label.push_back(label);
        }
      }
    }
  };
  add(film, false);
  add(face, true);
  for (int k = 0; k < around; ++k) {
    shape.rim.push_back(k);
  }
  return shape;
}

Turned cylinder(double height = 12.0) {
  return {"film", [=](double t) { return Vec3(kRadius, 0, height * t); }};
}
/// In the plane z = 0; width below 0: inwards.
Turned plate(double width = 12.0) {
  return {"face", [=](double t) { return Vec3(kRadius + width * t, 0, 0); }};
}

films::FilmSystem system_of(double radius, bool crease = false) {
  films::FilmSystem system;
  system.films = {{"film", films::FilmKind::Branch, {"rim"}, 1.0, {}}};
  if (crease) {
    system.films.push_back({"face", films::FilmKind::Disk, {"rim"}, 1.0, {}});
  }
  system.fillets.push_back({"foot", "rim", radius});
  return system;
}

fillets::FilletModel model_of(const Shape& shape,
                              const films::FilmSystem& system) {
  return {shape.mesh, system, {shape.rim}};
}

/// Cones to the origin: of an open surface good for differences, while its ends
/// stay.
double volume_of(const Shape& shape, const Points& x) {
  double sum = 0.0;
  for (const Triangle& t : shape.mesh.facets) {
    sum += x[t[0]].dot(x[t[1]].cross(x[t[2]])) / 6.0;
  }
  return sum;
}

/// What a fillet adds to the volume.
double added(const Shape& shape, bool crease = false) {
  const films::FilmSystem system = system_of(kBall, crease);
  const Points& x = shape.mesh.points;
  return volume_of(shape, model_of(shape, system).rounded(x, system)) -
         volume_of(shape, x);
}

double quarter_volume(double middle) {
  return 2.0 * kHalfTurn * middle * kArea * kBall * kBall;
}

/// Errors of the volume on two meshes, the second twice as fine.
double order_of(const std::function<double(int)>& error) {
  return std::log2(std::abs(error(1) / error(2)));
}

TEST(Fillet, FillsTheCornerByPappusVolumeAtOrderTwo) {
  const double exact = quarter_volume(kRadius + kMiddle * kBall);
  const auto error = [&](int fine) {
    return added(turned(cylinder(), plate(), 24 * fine, 48 * fine)) - exact;
  };
  EXPECT_LT(std::abs(error(2)), 0.02 * exact);

  EXPECT_GT(order_of(error), kLeastOrder);
}

TEST(Fillet, TakesAnOuterEdgeAwayByPappusVolumeAtOrderTwo) {
  const Turned lower = {"film",
                        [](double t) { return Vec3(kRadius, 0, -12.0 * t); }};
  const Turned lid = {"face",
                      [](double t) { return Vec3(kRadius - 8.0 * t, 0, 0); }};
  const double exact = -quarter_volume(kRadius - kMiddle * kBall);
  const auto error = [&](int fine) {
    Shape shape = turned(lower, lid, 24 * fine, 48 * fine);
    for (Triangle& t : shape.mesh.facets) {
      std::swap(t[1], t[2]);
    }
    return added(shape) - exact;
  };
  EXPECT_LT(std::abs(error(2)), 0.02 * std::abs(exact));
  EXPECT_GT(order_of(error), kLeastOrder);
}

TEST(Fillet, LiesOnTheTorusAndLeavesTheFaceFlat) {
  const Shape shape = turned(cylinder(), plate(), 24, 48);
  const films::FilmSystem system = system_of(kBall);
  const Points& x = shape.mesh.points;
  const Points y = model_of(shape, system).rounded(x, system);
  int on_arc = 0;
  for (std::size_t v = 0; v < y.size(); ++v) {
    const double r = std::hypot(y[v].x(), y[v].y());
    if (x[v].z() == 0.0) {  // face and rim
      EXPECT_NEAR(y[v].z(), 0.0, kTorusRounding);
      EXPECT_GE(r, kRadius + kBall - kTorusRounding);
      continue;
    }
    const double from_axis = r - (kRadius + kBall);
    if (y[v].z() < kBall && (y[v] - x[v]).norm() > kTorusRounding) {
      EXPECT_NEAR(std::hypot(from_axis, y[v].z() - kBall), kBall,
                  kTorusRounding);
      ++on_arc;
    } else {
      EXPECT_NEAR(r, kRadius, kTorusRounding);
    }
  }
  EXPECT_GE(on_arc, 3 * 48);  // rows of 0.5 between z = 0 and 2
}

TEST(Fillet, IsSharedByTwoFilmsThatMeet) {
  const Shape shape = turned(cylinder(), plate(), 48, 96);
  const double exact = quarter_volume(kRadius + kMiddle * kBall);
  EXPECT_NEAR(added(shape, true), exact, 0.01 * exact);
  const films::FilmSystem system = system_of(kBall, true);
  const Points y = model_of(shape, system).rounded(shape.mesh.points, system);
  // The curve goes to the middle of the arc.
  const double from_center = kBall * std::sqrt(0.5);
  for (const int v : shape.rim) {
    EXPECT_NEAR(std::hypot(y[v].x(), y[v].y()), kRadius + kBall - from_center,
                kTorusRounding);
    EXPECT_NEAR(y[v].z(), kBall - from_center, kTorusRounding);
  }
}

TEST(Fillet, OfRadiusZeroIsTheSurfaceItself) {
  const Shape shape = turned(cylinder(), plate(), 12, 24);
  const Points& x = shape.mesh.points;
  const films::FilmSystem none = system_of(0.0);
  const Points sharp = model_of(shape, none).rounded(x, none);
  // Where it was frozen round, its points come closer along it.
  const Points round = model_of(shape, system_of(kBall)).rounded(x, none);
  for (std::size_t v = 0; v < x.size(); ++v) {
    EXPECT_EQ(sharp[v], x[v]);
    const Vec3 off = round[v] - x[v];
    EXPECT_NEAR(off.head<2>().norm(), 0.0, kTorusRounding);
    EXPECT_NEAR(x[v].z() == 0.0 ? off.z() : 0.0, 0.0, kTorusRounding);
  }
  EXPECT_NEAR(volume_of(shape, round), volume_of(shape, x),
              kTorusRounding * volume_of(shape, x));
}

/// An uneven surface: its angle, and its curve, vary around.
Shape uneven(double flare) {
  const Turned film = {"film", [=](double t) {
                         return Vec3(kRadius + flare * t * t, 0, 12.0 * t);
                       }};
  return turned(film, plate(), 10, 36, [](const Vec3& p) {
    const double turn = std::atan2(p.y(), p.x());
    return Vec3(p + Vec3(0.1 * p.z() * std::cos(2.0 * turn),
                         0.8 * std::sin(turn) + 0.05 * p.z(),
                         0.02 * p.x() * p.y() / kRadius));
  });
}

Points random_points(std::size_t count, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Points points(count);
  for (Vec3& p : points) {
    p = Vec3(number(engine), number(engine), number(engine));
  }
  return points;
}

TEST(Fillet, TransposesToItsCentralDifferences) {
  for (const bool crease : {false, true}) {
    const Shape shape = uneven(2.0);
    const films::FilmSystem system = system_of(kBall, crease);
    const fillets::FilletModel model = model_of(shape, system);
    const Points& x = shape.mesh.points;
    const Points by = random_points(x.size(), 1);
    const Points way = random_points(x.size(), 2);
    // Away from the frozen surface, too.
    Points at = x;
    flat(at) += 0.02 * flat(random_points(x.size(), 3));
    const double radius = 1.1 * kBall;
    const auto worth = [&](double moved, double grown) {
      Points there = at;
      flat(there) += moved * flat(way);
      return flat(by).dot(
          flat(model.rounded(there, system_of(radius + grown, crease))));
    };
    const fillets::FilletGradient gradient =
        model.transpose(at, system_of(radius, crease), by);
    const double h = kDifferenceStep;
    const double by_film = (worth(h, 0.0) - worth(-h, 0.0)) / (2.0 * h);
    const double by_radius = (worth(0.0, h) - worth(0.0, -h)) / (2.0 * h);
    EXPECT_NEAR(flat(gradient.film).dot(flat(way)) / by_film, 1.0,
                kDifferenceError);
    EXPECT_NEAR(gradient.radius[0] / by_radius, 1.0, kDifferenceError);
  }
}

TEST(Fillet, TellsARadiusThatDoesNotFit) {
  const films::FilmSystem system = system_of(kBall);
  EXPECT_THAT([&] { model_of(turned(cylinder(), plate(2.2), 24, 48), system); },
              ThrowsMessage<InvalidInput>(AllOf(
                  HasSubstr("fillet 'foot': radius 2 does not fit on 'face'"),
                  HasSubstr("room for 1.65"))));
  const Shape wide = turned(cylinder(), plate(), 24, 48);
  const fillets::FilletModel model = model_of(wide, system);
  EXPECT_THAT([&] { model.rounded(wide.mesh.points, system_of(6.0)); },
              ThrowsMessage<InvalidInput>(HasSubstr(
                  "a ball of radius 6 does not fit in the corner at")));
  EXPECT_THAT([&] { model.rounded(wide.mesh.points, system_of(-1.0)); },
              ThrowsMessage<InvalidInput>(HasSubstr("must not be below 0")));
}

TEST(Fillet, IsBetweenTwoSurfacesAlongASmoothCurve) {
  Shape shape = turned(cylinder(), plate(), 6, 24);
  films::FilmSystem solid = system_of(kBall);
  solid.films.clear();
  EXPECT_THAT([&] { model_of(shape, solid); },
              ThrowsMessage<InvalidInput>(HasSubstr("no film ends")));
  EXPECT_THAT(
      [&] { model_of(turned(cylinder(), plate(), 6, 8), system_of(kBall)); },
      ThrowsMessage<InvalidInput>(HasSubstr("has a corner at")));
  shape.mesh.facets.push_back({0, 1, 40});
  shape.mesh.facet_label.push_back(0);
  EXPECT_THAT([&] { model_of(shape, system_of(kBall)); },
              ThrowsMessage<InvalidInput>(
                  HasSubstr("3 surfaces with material meet on curve 'rim'")));
}

}  // namespace
}  // namespace meniscus::fillet_model_test
