// Junctions that no film keeps, popped when a model is frozen.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/surface_mesh.h"
#include "evolve/frozen/film_model.h"

namespace meniscus::popped_films_test {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
constexpr double kHigh = 100.0;  // of the plates

using Plane = Eigen::Vector2d;

/// Four points with the shortest tree that joins them: legs at 120 degrees from
/// the ends of a bridge, the first two of one end.
struct Tree {
  std::array<Plane, 4> ends;
  double length = 0.0;
  double bridge = 0.0;
};

struct Legs {
  std::array<double, 4> length;
  double turn = 0.0;
};

/// Below 0 the bridge is none, and another tree is shorter.
Tree tree_of(const Legs& legs, double bridge) {
  Tree tree{.length = bridge, .bridge = bridge};
  for (int k = 0; k < 4; ++k) {
    const double side = k < 2 ? -1.0 : 1.0;
    const double angle =
        ((k < 2 ? 2.0 : -1.0) + (k % 2) * 2.0) * kPi / 3.0 + legs.turn;
    tree.ends[k] =
        0.5 * side * bridge * Plane(std::cos(legs.turn), std::sin(legs.turn)) +
        legs.length[k] * Plane(std::cos(angle), std::sin(angle));
    tree.length += legs.length[k];
  }
  return tree;
}

Legs random_legs(std::mt19937& random) {
  std::uniform_real_distribution<double> draw(0.0, 1.0);
  Legs legs;
  for (double& length : legs.length) {
    length = 8.0 + 5.0 * draw(random);
  }
  legs.turn = 2.0 * kPi * draw(random);
  return legs;
}

/// Plates from those points to an axis that begins at `axis`, in the order of
/// the points around it.
films::FilmSystem plates(const std::array<Plane, 4>& ends, const Plane& axis,
                         double high = kHigh) {
  films::FilmSystem system;
  for (int k = 0; k < 4; ++k) {
    const std::string name = "plate_" + std::to_string(k + 1);
    const auto at = [&](const Plane& p, double z) {
      return Vec3(p.x(), p.y(), z);
    };
    curves::Curve curve{
        name, curves::Polygon{{at(axis, 0.0), at(axis, high), at(ends[k], high),
                               at(ends[k], 0.0)}}};
    curve.free_sides = {0};
    system.curves.push_back(std::move(curve));
    system.films.push_back({name, films::FilmKind::Disk, {name}, 1.0});
  }
  system.pop = true;
  return system;
}

/// Length of what the plane cuts out of the films of that label, of all: -1.
double cut_length(const SurfaceMesh& mesh, double z, int label) {
  double length = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    Points cut;
    for (int k = 0; k < 3; ++k) {
      const Vec3& a = mesh.points[mesh.facets[f][k]];
      const Vec3& b = mesh.points[mesh.facets[f][(k + 1) % 3]];
      if ((a.z() < z) != (b.z() < z)) {
        cut.push_back(a + (z - a.z()) / (b.z() - a.z()) * (b - a));
      }
    }
    if (cut.size() == 2 && (label < 0 || mesh.facet_label[f] == label)) {
      length += (cut[1] - cut[0]).norm();
    }
  }
  return length;
}

// Half-way up the plates are those of the tree: their ends are far.
TEST(PoppedFilms, OfFourPlatesAreTheShortestTree) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  for (int k = 0; k < 6; ++k) {
    SCOPED_TRACE(k);
    const Legs legs = random_legs(random);
    const Tree tree = tree_of(legs, 17.0 + 5.0 * draw(random));
    const Plane axis(draw(random), draw(random));
    films::FilmSystem system = plates(tree.ends, axis);
    const frozen::FilmModelOptions options{.edge = 4.0, .refinements = 1};
    const frozen::FilmModel model = frozen::FilmModel::freeze(system, options);
    const settle::FilmState& found = model.reference();
    ASSERT_FALSE(found.failure) << found.failure->message;
    EXPECT_EQ(found.report.index, 0);
    ASSERT_EQ(found.report.popped.size(), 1U);
    const settle::PulledFilm& popped = found.report.popped[0];
    EXPECT_EQ(popped.name, "popped1");
    EXPECT_THAT(popped.pulled_from, HasSubstr("plate_"));
    EXPECT_NEAR(popped.place.z(), kHigh / 2.0, 1.0);
    const SurfaceMesh mesh = model.fine_mesh(found.points);
    const double z = 0.497 * kHigh;
    EXPECT_NEAR(cut_length(mesh, z, -1) / tree.length, 1.0, 2e-5);
    EXPECT_NEAR(cut_length(mesh, z, mesh.label_of("popped1")) / tree.bridge,
                1.0, 4e-3);
    // As before where nobody asks for it.
    system.pop = false;
    const frozen::FilmModel as_drawn =
        frozen::FilmModel::freeze(system, options);
    ASSERT_TRUE(as_drawn.reference().failure);
    EXPECT_EQ(as_drawn.reference().failure->kind, FailureKind::FilmUnstable);
    EXPECT_THAT(as_drawn.reference().failure->message,
                HasSubstr("more than three films meet along the line"));
    EXPECT_TRUE(as_drawn.reference().report.popped.empty());
  }
}

/// Design: an end's place, the axis', tensions of two plates.
constexpr int kNumbers = 6;
films::FilmSystem plates_at(const VectorX& at) {
  const Plane end(at[0], at[1]);
  films::FilmSystem system =
      plates({Plane(-14, 7), Plane(-13, -8), Plane(15, -6), end},
             Plane(at[2], at[3]), 40.0);
  system.films[1].tension = at[4];
  system.films[2].tension = at[5];
  return system;
}

/// How fast a system moves with its number k, in which it is linear.
template <class System>
films::FilmSystem rates_of(const System& system, const VectorX& at, int k) {
  const films::FilmSystem here = system(at);
  films::FilmSystem moving = system(at + VectorX::Unit(at.size(), k));
  for (std::size_t c = 0; c < moving.curves.size(); ++c) {
    auto& points = std::get<curves::Polygon>(moving.curves[c].shape).points;
    const auto& before = std::get<curves::Polygon>(here.curves[c].shape).points;
    for (std::size_t p = 0; p < points.size(); ++p) {
      points[p] -= before[p];
    }
  }
  for (std::size_t f = 0; f < moving.films.size(); ++f) {
    moving.films[f].tension -= here.films[f].tension;
  }
  for (std::size_t b = 0; b < moving.bodies.size(); ++b) {
    *moving.bodies[b].pressure -= *here.bodies[b].pressure;
  }
  return moving;
}

// A film that a pop made has the tension of the one that it was pulled from.
TEST(PoppedFilms, HaveExactGradients) {
  const VectorX start =
      (VectorX(kNumbers) << 13, 7, 0.5, -0.3, 1.1, 0.95).finished();
  const VectorX away =
      (VectorX(kNumbers) << 1, -0.5, 0.3, 0.4, -0.04, 0.05).finished();
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      plates_at(start), {.edge = 5.0, .refinements = 1});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  const std::string from = model.reference().report.popped.at(0).pulled_from;
  EXPECT_TRUE(from == "plate_2" || from == "plate_3") << from;
  for (const double far : {0.0, 1.0}) {
    const VectorX at = start + far * away;
    const films::FilmSystem system = plates_at(at);
    const settle::FilmState state = model.settle(system);
    ASSERT_FALSE(state.failure) << state.failure->message;
    EXPECT_EQ(state.report.popped.size(), 1U);
    frozen::FilmCovector by;
    by.points.resize(state.points.size());
    for (std::size_t v = 0; v < by.points.size(); ++v) {
      const auto k = static_cast<double>(v);
      by.points[v] = Vec3(std::sin(k), std::cos(2.0 * k), std::sin(3.0 * k));
    }
    by.energy = 0.4;
    const auto response = [&](const VectorX& there) {
      const settle::FilmState film = model.settle(plates_at(there));
      return flat(by.points).dot(flat(film.points)) +
             by.energy * film.report.energy;
    };
    const frozen::FilmGradient gradient =
        model.transpose(state, system, {by})[0];
    for (int k = 0; k < kNumbers; ++k) {
      constexpr double kStep = 1e-4;
      const VectorX step = kStep * VectorX::Unit(kNumbers, k);
      const double slope =
          (response(at + step) - response(at - step)) / (2.0 * kStep);
      EXPECT_NEAR(model.rate(gradient, system, rates_of(plates_at, at, k)),
                  slope, 2e-6 * std::max(1.0, std::abs(slope)))
          << far << ' ' << k;
    }
  }
}

/// The same with chambers between the plates, one of them under a pressure.
films::FilmSystem chambers_at(const VectorX& at) {
  const std::array<Plane, 4> ends = {Plane(-14, 7), Plane(-13, -8),
                                     Plane(15, -6), Plane(at[0], 7)};
  const Plane axis(0.5, -0.3);
  constexpr double kTall = 40.0;
  films::FilmSystem system = plates(ends, axis, kTall);
  system.films[1].tension = at[1];
  system.films[2].tension = at[1];
  for (int k = 0; k < 4; ++k) {
    const Plane& a = ends[k];
    const Plane& b = ends[(k + 1) % 4];
    const auto up = [](const Plane& p, double z) {
      return Vec3(p.x(), p.y(), z);
    };
    const std::string number = std::to_string(k + 1);
    films::BodySpec body{
        .name = "cell_" + number,
        .enclosed_by = {"plate_" + number,
                        "plate_" + std::to_string((k + 1) % 4 + 1)}};
    const std::array<Points, 3> faces = {
        {{up(axis, 0), up(b, 0), up(a, 0)},
         {up(axis, kTall), up(a, kTall), up(b, kTall)},
         {up(a, 0), up(b, 0), up(b, kTall), up(a, kTall)}}};
    for (int f = 0; f < 3; ++f) {
      const std::string name = "face_" + number + "_" + std::to_string(f);
      system.curves.push_back({name, curves::Polygon{faces[f]}});
      system.caps.push_back({name, name});
      body.enclosed_by.push_back(name);
    }
    body.pressure = k == 0 ? at[2] : 0.0;
    system.bodies.push_back(std::move(body));
  }
  return system;
}

TEST(PoppedFilms, PartTheBodiesOnTheirSides) {
  const VectorX start = (VectorX(3) << 13, 1.05, 0.004).finished();
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      chambers_at(start), {.edge = 5.0, .refinements = 1});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  ASSERT_EQ(model.reference().report.popped.size(), 1U);
  const VectorX at = start + (VectorX(3) << 1, -0.03, 0.003).finished();
  const settle::FilmState state = model.settle(chambers_at(at));
  ASSERT_FALSE(state.failure) << state.failure->message;
  // Together the chambers are the prism on the four points.
  double volume = 0.0;
  for (const settle::BodyState& body : state.report.bodies) {
    volume += body.volume;
  }
  const std::array<Plane, 4> ends = {Plane(-14, 7), Plane(-13, -8),
                                     Plane(15, -6), Plane(at[0], 7)};
  double area = 0.0;
  for (int k = 0; k < 4; ++k) {
    const Plane& a = ends[k];
    const Plane& b = ends[(k + 1) % 4];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  EXPECT_NEAR(volume / (40.0 * area), 1.0, 1e-12);
  frozen::FilmCovector by;
  by.points.resize(state.points.size());
  for (std::size_t v = 0; v < by.points.size(); ++v) {
    const auto k = static_cast<double>(v);
    by.points[v] = Vec3(std::sin(k), std::cos(2.0 * k), std::sin(3.0 * k));
  }
  const auto response = [&](const VectorX& there) {
    return flat(by.points).dot(flat(model.settle(chambers_at(there)).points));
  };
  const frozen::FilmGradient gradient =
      model.transpose(state, chambers_at(at), {by})[0];
  for (int k = 0; k < 3; ++k) {
    const VectorX step = (k == 0 ? 1e-4 : 1e-5) * VectorX::Unit(3, k);
    const double slope =
        (response(at + step) - response(at - step)) / (2.0 * step[k]);
    EXPECT_NEAR(
        model.rate(gradient, chambers_at(at), rates_of(chambers_at, at, k)),
        slope, 2e-6 * std::max(1.0, std::abs(slope)))
        << k;
  }
}

// Where the bridge of the tree ends its two lines run together.
TEST(PoppedFilms, TellWhereFilmsJoinInAnotherWay) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  for (int k = 0; k < 3; ++k) {
    SCOPED_TRACE(k);
    const Legs legs = random_legs(random);
    const Plane axis(draw(random), draw(random));
    const double usual = 17.0 + 5.0 * draw(random);
    const auto system = [&](double bridge) {
      return plates(tree_of(legs, bridge).ends, axis, 50.0);
    };
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        system(usual), {.edge = 4.0, .refinements = 0});
    ASSERT_FALSE(model.reference().failure);
    const settle::FilmState stands = model.settle(system(0.5 * usual));
    EXPECT_FALSE(stands.failure) << stands.failure->message;
    const settle::FilmState joined = model.settle(system(-0.4 * usual));
    ASSERT_TRUE(joined.failure);
    EXPECT_EQ(joined.failure->kind, FailureKind::FilmRejoins)
        << joined.failure->message;
    EXPECT_THAT(joined.failure->message, HasSubstr("popped1"));
  }
}

// So does the third of three plates whose outer edge comes between those of the
// others, where the angle to these becomes 120 degrees.
TEST(PoppedFilms, TellWhereALineRunsIntoARim) {
  const auto system = [](double x) {
    films::FilmSystem plates = popped_films_test::plates(
        {Plane(-10, 15), Plane(-10, -15), Plane(x, 0), Plane(x, 0)},
        Plane(0.5, 0.3), 50.0);
    plates.curves.pop_back();
    plates.films.pop_back();
    return plates;
  };
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system(18.0), {.edge = 4.0, .refinements = 0});
  ASSERT_FALSE(model.reference().failure);
  EXPECT_TRUE(model.reference().report.popped.empty());
  EXPECT_FALSE(model.settle(system(8.0)).failure);
  // The line stands at -10 + 15 / sqrt(3), -1.3.
  const settle::FilmState run = model.settle(system(-6.0));
  ASSERT_TRUE(run.failure);
  EXPECT_EQ(run.failure->kind, FailureKind::FilmRejoins)
      << run.failure->message;
  EXPECT_THAT(run.failure->message,
              HasSubstr("the line at which film 'plate_3' ends runs into"));
}

// A film may fail for other reasons although it has lines.
TEST(PoppedFilms, TellNothingOfLinesThatStayApart) {
  const auto rings = [](double half) {
    films::FilmSystem system;
    system.curves = {
        {"low", curves::Circle{Vec3(0, 0, -half), Vec3::UnitZ(), 1.0}},
        {"line", curves::Circle{Vec3::Zero(), Vec3::UnitZ(), 0.95}},
        {"high", curves::Circle{Vec3(0, 0, half), Vec3::UnitZ(), 1.0}}};
    system.curves[1].free = true;
    system.films = {{"below", films::FilmKind::Loft, {"low", "line"}, 1.0},
                    {"above", films::FilmKind::Loft, {"line", "high"}, 1.0},
                    {"web", films::FilmKind::Disk, {"line"}, 0.1}};
    return system;
  };
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(rings(0.3), {.edge = 0.2, .refinements = 0});
  ASSERT_FALSE(model.reference().failure);
  const settle::FilmState torn = model.settle(rings(0.9));
  ASSERT_TRUE(torn.failure);
  EXPECT_NE(torn.failure->kind, FailureKind::FilmRejoins)
      << torn.failure->message;
}

// Twelve films from the edges of a cube meet in its middle: eight lines, which
// no film keeps. A small film comes between them.
TEST(PoppedFilms, OfACubePartItsMiddle) {
  films::FilmSystem system;
  Points corners;
  for (int c = 0; c < 8; ++c) {
    corners.emplace_back(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1);
  }
  for (int a = 0; a < 8; ++a) {
    for (const int bit : {1, 2, 4}) {
      if ((a & bit) == 0) {
        const std::string name =
            std::to_string(a) + "_" + std::to_string(a | bit);
        system.curves.push_back(
            {name, curves::Polygon{{corners[a], corners[a | bit],
                                    Vec3(0.01, 0.02, 0.05)}}});
        system.curves.back().free_sides = {1, 2};
        system.films.push_back({name, films::FilmKind::Disk, {name}, 1.0});
      }
    }
  }
  system.pop = true;
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = 0.3, .refinements = 1});
  const settle::FilmState& found = model.reference();
  ASSERT_FALSE(found.failure) << found.failure->message;
  EXPECT_EQ(found.report.index, 0);
  EXPECT_EQ(found.report.popped.size(), 1U);
  const double cone = 12.0 * std::sqrt(2.0);
  EXPECT_LT(found.report.energy, 0.9999 * cone);
}

}  // namespace
}  // namespace meniscus::popped_films_test
