// Films that begin along a free curve and meet where they balance.
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "evolve/frozen/film_model.h"

namespace meniscus::free_lines_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHalf = 0.3;  // of the distance of the rings

/// Two rings of radius 1 with a disk across the middle of the film between
/// them, whose line begins off its place.
films::FilmSystem two_rings(double tension, double aside = 0.0,
                            double lower = 1.0) {
  films::FilmSystem system;
  system.curves = {
      {"low", curves::Circle{Vec3(0, 0, -kHalf), Vec3::UnitZ(), lower}},
      {"line", curves::Circle{Vec3(0.04, 0, 0.05), Vec3(0.1, 0, 1), 0.95}},
      {"high", curves::Circle{Vec3(aside, 0, kHalf), Vec3::UnitZ(), 1.0}}};
  system.curves[1].free = true;
  system.films = {{"below", films::FilmKind::Loft, {"low", "line"}, 1.0},
                  {"above", films::FilmKind::Loft, {"line", "high"}, 1.0},
                  {"web", films::FilmKind::Disk, {"line"}, tension}};
  return system;
}

/// Vertices where all films meet.
std::vector<int> line_of(const SurfaceMesh& mesh) {
  std::vector<int> films(mesh.points.size(), 0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (const int v : mesh.facets[f]) {
      films[v] |= 1 << mesh.facet_label[f];
    }
  }
  const int all = (1 << mesh.labels.size()) - 1;
  std::vector<int> result;
  for (std::size_t v = 0; v < films.size(); ++v) {
    if (films[v] == all) {
      result.push_back(static_cast<int>(v));
    }
  }
  return result;
}

struct Box {
  Vec3 low;
  Vec3 high;
};

Box box_of(const SurfaceMesh& mesh) {
  Box box{Vec3::Constant(9.0), Vec3::Constant(-9.0)};
  for (const int v : line_of(mesh)) {
    box.low = box.low.cwiseMin(mesh.points[v]);
    box.high = box.high.cwiseMax(mesh.points[v]);
  }
  return box;
}

/// r = c cosh(z / c + b) with the slope sinh b that a web of that tension
/// needs at z = 0: sin of its angle is half the tension (Young, Plateau).
struct Exact {
  explicit Exact(double tension) {
    const double slope = std::tan(std::asin(0.5 * tension));
    b = std::asinh(slope);
    double low = 0.35;  // c cosh(h / c + b) = 1: the thick one of two
    double high = 1.0;
    for (int k = 0; k < 200; ++k) {
      c = 0.5 * (low + high);
      (c * std::cosh(kHalf / c + b) < 1.0 ? low : high) = c;
    }
    radius = c * std::cosh(b);
    const auto to = [](double u) { return u + std::sinh(u) * std::cosh(u); };
    energy = 2.0 * kPi * c * c * (to(kHalf / c + b) - to(b)) +
             tension * kPi * radius * radius;
  }
  double b = 0.0;
  double c = 0.0;
  double radius = 0.0;  // of the line
  double energy = 0.0;
};

// At 120 degrees for equal tensions, at Neumann's angles for others.
TEST(FreeLine, OfARingedDiskIsThatOfTwoCatenoids) {
  for (const double tension : {1.0, 0.6, 1.3}) {
    const Exact exact(tension);
    std::vector<double> energy_off;
    std::vector<double> radius_off;
    for (const int refinements : {0, 1, 2}) {
      const frozen::FilmModel model = frozen::FilmModel::freeze(
          two_rings(tension), {.edge = 0.15, .refinements = refinements});
      const settle::FilmState& found = model.reference();
      ASSERT_FALSE(found.failure) << found.failure->message;
      EXPECT_EQ(found.report.index, 0);
      energy_off.push_back(std::abs(found.report.energy / exact.energy - 1.0));
      const SurfaceMesh mesh = model.fine_mesh(found.points);
      const std::vector<int> line = line_of(mesh);
      ASSERT_GT(line.size(), 20U);
      double mean = 0.0;
      for (const int v : line) {
        const Vec3& p = mesh.points[v];
        EXPECT_NEAR(p.z(), 0.0, 1e-2);
        mean += p.head<2>().norm() / static_cast<double>(line.size());
      }
      radius_off.push_back(std::abs(mean / exact.radius - 1.0));
    }
    SCOPED_TRACE(tension);
    EXPECT_LT(energy_off[2], 1e-3);
    EXPECT_LT(radius_off[2], 1e-3);
    EXPECT_GT(energy_off[0] / energy_off[2], 10.0);
  }
}

// The line goes where the design takes it: a model that was frozen elsewhere
// finds the same film as one that is frozen there.
TEST(FreeLine, FollowsTheDesign) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      two_rings(1.0), {.edge = 0.1, .refinements = 1});
  ASSERT_FALSE(model.reference().failure);
  const films::FilmSystem there = two_rings(0.8, 0.12, 0.92);
  const settle::FilmState moved = model.settle(there);
  ASSERT_FALSE(moved.failure) << moved.failure->message;
  const frozen::FilmModel anew =
      frozen::FilmModel::freeze(there, {.edge = 0.1, .refinements = 1});
  ASSERT_FALSE(anew.reference().failure);
  EXPECT_NEAR(moved.report.energy / anew.reference().report.energy, 1.0, 1e-3);
  const Box one = box_of(model.fine_mesh(moved.points));
  const Box other = box_of(anew.fine_mesh(anew.reference().points));
  EXPECT_GT(one.low.x() + one.high.x(), 0.06);
  EXPECT_LT((one.low - other.low).norm(), 5e-3);
  EXPECT_LT((one.high - other.high).norm(), 5e-3);
}

/// A tube of two chambers that a web parts, its line free: two volumes held,
/// the lower ring given by `numbers`, the tension of the web among them.
films::FilmSystem chambers(const VectorX& numbers) {
  films::FilmSystem system = two_rings(numbers[0], numbers[1], numbers[2]);
  system.caps = {{"floor", "low"}, {"lid", "high"}};
  system.bodies = {{"down", {"below", "web", "floor"}, numbers[3], {}},
                   {"up", {"above", "web", "lid"}, {}, numbers[4]}};
  return system;
}

const VectorX kChambers = (VectorX(5) << 0.9, 0.0, 1.0, 1.0, 0.3).finished();

// At the reference and away from it, where lines are led to first order.
TEST(FreeLine, HasExactGradients) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      chambers(kChambers), {.edge = 0.15, .refinements = 1});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  const VectorX away = (VectorX(5) << 0.1, 0.05, -0.04, 0.04, 0.1).finished();
  for (const double far : {0.0, 1.0}) {
    const VectorX at = kChambers + far * away;
    const films::FilmSystem system = chambers(at);
    const settle::FilmState state = model.settle(system);
    ASSERT_FALSE(state.failure) << state.failure->message;
    frozen::FilmCovector by;
    by.points.resize(state.points.size());
    for (std::size_t v = 0; v < by.points.size(); ++v) {
      const auto k = static_cast<double>(v);
      by.points[v] = Vec3(std::sin(k), std::cos(2.0 * k), std::sin(3.0 * k));
    }
    by.pressures = Eigen::Vector2d(0.7, -0.2);
    by.energy = 0.4;
    const auto response = [&](const settle::FilmState& film) {
      return flat(by.points).dot(flat(film.points)) +
             by.pressures[0] * film.report.bodies[0].pressure +
             by.pressures[1] * film.report.bodies[1].pressure +
             by.energy * film.report.energy;
    };
    const frozen::FilmGradient gradient =
        model.transpose(state, system, {by})[0];
    std::vector<films::FilmSystem> rates;
    for (int k = 0; k < 5; ++k) {
      constexpr double kStep = 1e-5;
      const VectorX step = kStep * VectorX::Unit(5, k);
      const double slope = (response(model.settle(chambers(at + step))) -
                            response(model.settle(chambers(at - step)))) /
                           (2.0 * kStep);
      films::FilmSystem moving = chambers(VectorX::Zero(5));
      for (films::FilmSpec& film : moving.films) {
        film.tension = 0.0;
      }
      for (curves::Curve& curve : moving.curves) {
        curve.shape = curves::Circle{Vec3::Zero(), Vec3::Zero(), 0.0};
      }
      moving.bodies[0].volume = moving.bodies[1].pressure = 0.0;
      auto& low = std::get<curves::Circle>(moving.curves[0].shape);
      auto& high = std::get<curves::Circle>(moving.curves[2].shape);
      k == 0   ? moving.films[2].tension = 1.0
      : k == 1 ? high.center.x() = 1.0
      : k == 2 ? low.radius = 1.0
      : k == 3 ? *(moving.bodies[0].volume = 1.0)
               : *(moving.bodies[1].pressure = 1.0);
      const double found = model.rate(gradient, system, moving);
      EXPECT_NEAR(found, slope, 1e-6 * std::max(1.0, std::abs(slope)))
          << far << ' ' << k;
      rates.push_back(moving);
    }
    const std::vector<Points> tangents = model.tangents(state, system, rates);
    by.pressures = VectorX();
    by.energy = 0.0;
    const frozen::FilmGradient of_points =
        model.transpose(state, system, {by})[0];
    for (std::size_t k = 0; k < rates.size(); ++k) {
      const double forward = flat(by.points).dot(flat(tangents[k]));
      EXPECT_NEAR(model.rate(of_points, system, rates[k]), forward,
                  1e-9 * std::max(1.0, std::abs(forward)));
    }
  }
}

// Over a way of several edges the film is a polynomial of the design to 1e-9:
// Chebyshev's of degree 24 through as many places meets it between them.
TEST(FreeLine, IsSmoothOverItsReach) {
  constexpr int kPlaces = 25;
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      chambers(kChambers), {.edge = 0.15, .refinements = 1});
  ASSERT_FALSE(model.reference().failure);
  const VectorX away = (VectorX(5) << 0.2, 0.1, -0.08, 0.1, 0.1).finished();
  const auto film = [&](double x) {
    const settle::FilmState state =
        model.settle(chambers(kChambers + x * away));
    EXPECT_FALSE(state.failure) << x << state.failure->message;
    return state.points;
  };
  std::vector<double> at;
  std::vector<double> weight;
  std::vector<Points> films;
  for (int k = 0; k < kPlaces; ++k) {
    const double angle = kPi * (k + 0.5) / kPlaces;
    at.push_back(std::cos(angle));
    weight.push_back((k % 2 == 0 ? 1.0 : -1.0) * std::sin(angle));
    films.push_back(film(at.back()));
  }
  double motion = 0.0;
  for (std::size_t v = 0; v < films[0].size(); ++v) {
    motion = std::max(motion, (films.front()[v] - films.back()[v]).norm());
  }
  EXPECT_GT(motion, 0.15);  // two edges of this mesh
  for (const double x : {-0.93, -0.41, 0.07, 0.66, 0.97}) {
    const Points found = film(x);
    Points between(found.size(), Vec3::Zero());
    double sum = 0.0;
    for (int k = 0; k < kPlaces; ++k) {  // barycentric (Berrut, Trefethen 2004)
      const double share = weight[k] / (x - at[k]);
      sum += share;
      flat(between) += share * flat(films[k]);
    }
    flat(between) /= sum;
    EXPECT_LT((flat(between) - flat(found)).cwiseAbs().maxCoeff(), 1e-9) << x;
  }
}

// A plane of symmetry cuts the line, which ends there and slides in it.
TEST(FreeLine, EndsAtAPlaneOfSymmetry) {
  const auto at = [](const VectorX& numbers, bool half) {
    films::FilmSystem system = chambers(numbers);
    auto& line = std::get<curves::Circle>(system.curves[1].shape);
    line.normal = Vec3::UnitZ();
    for (int b = 0; b < 2 && half; ++b) {
      films::CapSpec face;
      face.name = "cut_" + std::to_string(b);
      face.wall = films::FilmWall{.normal = Vec3::UnitY(), .cuts = true};
      system.caps.push_back(face);
      system.bodies[b].enclosed_by.push_back(face.name);
    }
    if (half) {
      *system.bodies[0].volume /= 2.0;
    }
    return system;
  };
  const frozen::FilmModelOptions options{.edge = 0.15, .refinements = 1};
  const frozen::FilmModel whole =
      frozen::FilmModel::freeze(at(kChambers, false), options);
  const frozen::FilmModel half =
      frozen::FilmModel::freeze(at(kChambers, true), options);
  ASSERT_FALSE(half.reference().failure) << half.reference().failure->message;
  EXPECT_NEAR(2.0 * half.reference().report.energy,
              whole.reference().report.energy, 2e-3);
  const VectorX away =
      kChambers + (VectorX(5) << 0.1, 0.05, -0.04, 0.04, 0.1).finished();
  const settle::FilmState moved = half.settle(at(away, true));
  ASSERT_FALSE(moved.failure) << moved.failure->message;
  EXPECT_NEAR(2.0 * moved.report.energy,
              whole.settle(at(away, false)).report.energy, 2e-3);
}

/// Six films from the edges of a tetrahedron to a point that nothing holds,
/// with one corner off its place.
films::FilmSystem tetrahedron(const Vec3& middle, const Vec3& off) {
  const Points corners = {Vec3(1, 1, 1) + off, Vec3(1, -1, -1), Vec3(-1, 1, -1),
                          Vec3(-1, -1, 1)};
  films::FilmSystem system;
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) {
      const std::string name = std::to_string(a) + std::to_string(b);
      system.curves.push_back(
          {name, curves::Polygon{{corners[a], corners[b], middle}}});
      system.curves.back().free_sides = {1, 2};
      system.films.push_back({name, films::FilmKind::Disk, {name}, 1.0});
    }
  }
  return system;
}

// Flat films have no error: six triangles of edge^2 / (4 sqrt 2), four lines
// that meet at the centre.
TEST(FreeSide, FramesOfATetrahedronMeetAtItsCentre) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      tetrahedron(Vec3(0.1, -0.05, 0.12), Vec3::Zero()),
      {.edge = 0.4, .refinements = 1});
  const settle::FilmState& found = model.reference();
  ASSERT_FALSE(found.failure) << found.failure->message;
  EXPECT_EQ(found.report.index, 0);
  const double edge2 = 8.0;
  EXPECT_NEAR(found.report.energy, 6.0 * edge2 / (4.0 * std::sqrt(2.0)), 1e-9);
  double nearest = 9.0;
  for (const Vec3& p : found.points) {
    nearest = std::min(nearest, p.norm());
  }
  EXPECT_LT(nearest, 1e-9);
}

TEST(FreeSide, MovesWithTheCornerThatTheDesignMoves) {
  const Vec3 middle(0.05, 0.0, 0.0);
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      tetrahedron(middle, Vec3::Zero()), {.edge = 0.3, .refinements = 1});
  ASSERT_FALSE(model.reference().failure);
  const Vec3 off(0.5, 0.2, -0.3);
  const films::FilmSystem there = tetrahedron(middle, off);
  const settle::FilmState moved = model.settle(there);
  ASSERT_FALSE(moved.failure) << moved.failure->message;
  const frozen::FilmModel anew =
      frozen::FilmModel::freeze(there, {.edge = 0.3, .refinements = 1});
  EXPECT_NEAR(moved.report.energy / anew.reference().report.energy, 1.0, 1e-4);
  const frozen::FilmGradient gradient =
      model.transpose(moved, there, {{.energy = 1.0}})[0];
  for (int k = 0; k < 3; ++k) {
    constexpr double kStep = 1e-5;
    const Vec3 step = kStep * Vec3::Unit(k);
    const double slope =
        (model.settle(tetrahedron(middle, off + step)).report.energy -
         model.settle(tetrahedron(middle, off - step)).report.energy) /
        (2.0 * kStep);
    films::FilmSystem moving = tetrahedron(Vec3::Zero(), Vec3::Zero());
    for (std::size_t c = 0; c < moving.curves.size(); ++c) {
      moving.curves[c].shape =
          curves::Polygon{{c < 3 ? Vec3(Vec3::Unit(k)) : Vec3(Vec3::Zero()),
                           Vec3::Zero(), Vec3::Zero()}};
      moving.films[c].tension = 0.0;
    }
    EXPECT_NEAR(model.rate(gradient, there, moving), slope, 1e-7);
  }
}

// Where the curve was drawn has no say.
TEST(FreeLine, ForgetsWhereItBegan) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      two_rings(1.0), {.edge = 0.15, .refinements = 0});
  ASSERT_FALSE(model.reference().failure);
  films::FilmSystem other = two_rings(1.0);
  other.curves[1].shape = curves::Circle{Vec3(0, 0, 5), Vec3::UnitX(), 3.0};
  EXPECT_EQ(model.settle(other).points, model.reference().points);
}

/// The two rings with one film between them, which the web joins.
films::FilmSystem joined_rings(double tension, const curves::Circle& guess) {
  films::FilmSystem system = two_rings(tension);
  system.curves[1].shape = guess;
  system.films = {{"skin", films::FilmKind::Loft, {"low", "high"}, 1.0},
                  {"web", films::FilmKind::Disk, {"line"}, tension}};
  system.films[1].joins = {"skin"};
  return system;
}

// The line is that of two films that a curve parts, wherever it was drawn.
TEST(JoinedFilm, FindsThePlaceOfARingedDisk) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  for (const double tension : {1.0, 0.6, 1.3}) {
    const Exact exact(tension);
    const Vec3 place(0.1 * within(random), 0.1 * within(random),
                     0.12 * within(random));
    const Vec3 normal(0.2 * within(random), 0.2 * within(random), 1.0);
    const curves::Circle guess{place, normal, 0.9 + 0.15 * within(random)};
    std::vector<double> off;
    for (const int refinements : {0, 1, 2}) {
      const frozen::FilmModel model =
          frozen::FilmModel::freeze(joined_rings(tension, guess),
                                    {.edge = 0.15, .refinements = refinements});
      const settle::FilmState& found = model.reference();
      ASSERT_FALSE(found.failure) << found.failure->message;
      EXPECT_EQ(found.report.index, 0);
      off.push_back(std::abs(found.report.energy / exact.energy - 1.0));
      const SurfaceMesh mesh = model.fine_mesh(found.points);
      const std::vector<int> line = line_of(mesh);
      ASSERT_GT(line.size(), 20U);
      for (const int v : line) {
        EXPECT_NEAR(mesh.points[v].z(), 0.0, 1e-2);
        EXPECT_NEAR(mesh.points[v].head<2>().norm(), exact.radius, 2e-2);
      }
    }
    SCOPED_TRACE(tension);
    EXPECT_LT(off[2], 1e-3);
    EXPECT_GT(off[0] / off[2], 10.0);
  }
}

/// A skin in a frame of four corners, two sides of which rise to where a plate
/// ends that stands on it; `cut`: the skin is two films that begin along the
/// plate's foot.
films::FilmSystem plate_on_skin(const Points& frame, const Points& top,
                                double tension, const Vec3& foot, bool cut,
                                double rise = 0.0) {
  const Vec3 from = 0.5 * (frame[0] + frame[1]) + rise * Vec3::UnitZ();
  const Vec3 to = 0.5 * (frame[2] + frame[3]) + rise * Vec3::UnitZ();
  films::FilmSystem system;
  // A corner amid the foot, where it is drawn.
  system.curves = {
      {"skin",
       curves::Polygon{{frame[0], from, frame[1], frame[2], to, frame[3]}}},
      {"plate", curves::Polygon{{from, foot, to, top[1], top[0]}}},
      {"left", curves::Polygon{{from, frame[1], frame[2], to, foot}}},
      {"right", curves::Polygon{{from, foot, to, frame[3], frame[0]}}}};
  system.curves[1].free_sides = {0, 1};
  system.curves[2].free_sides = {3, 4};
  system.curves[3].free_sides = {0, 1};
  system.films = {{"plate", films::FilmKind::Disk, {"plate"}, tension}};
  if (cut) {
    system.films.push_back({"left", films::FilmKind::Disk, {"left"}, 1.0});
    system.films.push_back({"right", films::FilmKind::Disk, {"right"}, 1.0});
  } else {
    system.films[0].joins = {"skin"};
    system.films.push_back({"skin", films::FilmKind::Disk, {"skin"}, 1.0});
  }
  return system;
}

// Random frames, plates and tensions: the same film as of a skin that is drawn
// in two parts, the difference falling with the square of the edge.
TEST(JoinedFilm, IsThatOfASkinDrawnInTwoParts) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> by(-0.25, 0.25);
  const auto near = [&](double x, double y, double z) {
    return Vec3(x + by(random), y + by(random), z + by(random));
  };
  for (int k = 0; k < 6; ++k) {
    const Points frame = {near(-1, -1, 0), near(1, -1, 0), near(1, 1, 0),
                          near(-1, 1, 0)};
    const Points top = {near(0, -1, 1.6), near(0, 1, 1.6)};
    const Vec3 foot = near(0, 0, 0.4);
    // At its ends the line is held; the frame leaves it there about as the
    // tensions want it, else it would climb (docs/theory.md).
    const double tension = 0.8 + 2.0 * by(random);
    const double rise = std::tan(std::asin(0.5 * tension));
    std::vector<double> apart;
    for (const int refinements : {0, 2}) {
      std::vector<double> energy;
      for (const bool cut : {false, true}) {
        const frozen::FilmModel model = frozen::FilmModel::freeze(
            plate_on_skin(frame, top, tension, foot, cut, rise),
            {.edge = 0.2, .refinements = refinements});
        const settle::FilmState& found = model.reference();
        ASSERT_FALSE(found.failure)
            << k << cut << refinements << ' ' << found.failure->message;
        EXPECT_EQ(found.report.index, 0);
        energy.push_back(found.report.energy);
      }
      apart.push_back(std::abs(energy[0] / energy[1] - 1.0));
    }
    EXPECT_LT(apart[1], 3e-6) << k;
    EXPECT_LT(apart[1], 0.3 * apart[0] + 1e-6) << k;
  }
}

// A second plate ends on skin and first plate: four lines in two points of
// rims, three films along each.
TEST(JoinedFilm, JoinsAnotherThatJoins) {
  const Points frame = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0.2),
                        Vec3(-1, 1, 0)};
  films::FilmSystem system = plate_on_skin(
      frame, {Vec3(0, -1, 1), Vec3(0.1, 1, 1)}, 0.8, Vec3(0.05, 0, 0.1), false);
  const Vec3 side = 0.5 * (frame[1] + frame[2]);
  const Vec3 top = 0.5 * (Vec3(0, -1, 1) + Vec3(0.1, 1, 1));
  system.curves.push_back(
      {"second", curves::Polygon{{Vec3(0.05, 0, 0.1), side, top}}});
  system.curves.back().free_sides = {0, 2};
  system.films.push_back({"second", films::FilmKind::Disk, {"second"}, 0.5});
  system.films.back().joins = {"skin", "plate"};
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = 0.15, .refinements = 1});
  const settle::FilmState& found = model.reference();
  ASSERT_FALSE(found.failure) << found.failure->message;
  EXPECT_EQ(found.report.index, 0);
  const std::vector<int> three = line_of(model.fine_mesh(found.points));
  EXPECT_EQ(three.size(), 1U);  // all three films in one point alone
}

std::string failure_of(const films::FilmSystem& system) {
  try {
    static_cast<void>(
        frozen::FilmModel::freeze(system, {.edge = 0.2, .refinements = 0}));
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(JoinedFilm, SaysWhereItCannotEnd) {
  const Points frame = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0),
                        Vec3(-1, 1, 0)};
  const films::FilmSystem good = plate_on_skin(
      frame, {Vec3(0, -1, 1), Vec3(0, 1, 1)}, 0.8, Vec3(0, 0, 0.1), false);
  EXPECT_EQ(failure_of(good), "");
  films::FilmSystem amid = good;
  std::get<curves::Polygon>(amid.curves[1].shape).points[0] =
      Vec3(0, -0.6, 0.0);
  EXPECT_NE(failure_of(amid).find("ends at (0, -0.6, 0), where no curve"),
            std::string::npos)
      << failure_of(amid);
  films::FilmSystem around = good;
  around.films[1].joins = {"plate"};
  around.curves[0].free_sides = {0};
  EXPECT_NE(failure_of(around).find("joins films that join it"),
            std::string::npos)
      << failure_of(around);
}

// It shrinks to its line, where films coincide and no line can be popped.
TEST(JoinedFilm, ThatNothingHoldsComesToAnEnd) {
  const curves::Circle beside{Vec3(1, 0, 0), Vec3::UnitX(), 0.25};
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      joined_rings(0.3, beside), {.edge = 0.15, .refinements = 0});
  EXPECT_TRUE(model.reference().failure);
}

}  // namespace
}  // namespace meniscus::free_lines_test
