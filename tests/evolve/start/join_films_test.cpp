#include "evolve/start/join_films.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/geometry/edge_key.h"
#include "evolve/start/start_complex.h"
#include "tests/support/check_complex.h"

namespace meniscus::join_films_test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kHigh = 0.7;  // of the tube, whose radius is 1

/// A tube; low and high rim are of radius 1.
films::FilmSystem tube() {
  films::FilmSystem system;
  system.curves = {
      {"low", curves::Circle{Vec3::Zero(), Vec3::UnitZ(), 1.0}},
      {"high", curves::Circle{kHigh * Vec3::UnitZ(), Vec3::UnitZ(), 1.0}}};
  system.films = {{"skin", films::FilmKind::Loft, {"low", "high"}, 1.0}};
  return system;
}

Vec3 place(double angle, double radius, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

void add_plate(films::FilmSystem& system, const Points& corners,
               std::vector<int> free_sides) {
  const std::string name = fmt::format("plate_{}", system.films.size());
  system.curves.push_back({name, curves::Polygon{corners}});
  system.curves.back().free_sides = std::move(free_sides);
  system.films.push_back({name, films::FilmKind::Disk, {name}, 0.3});
  system.films.back().joins = {"skin"};
}

/// That stands outside, its foot from one place of the low rim to one of the
/// high one.
void add_fin(films::FilmSystem& system, double low, double high) {
  add_plate(system,
            {place(low, 1.0, 0.0), place(low, 1.6, 0.0),
             place(high, 1.6, kHigh), place(high, 1.0, kHigh)},
            {3});
}

/// Each edge has one, two or three facets; a rim's has one, a line's those of
/// three films or of one that passes and one that ends.
void expect_lines(const films::FilmSystem& system,
                  const films::FilmComplex& start) {
  test_films::check_complex(start);
  std::map<Edge, std::vector<int>> films;
  for (std::size_t f = 0; f < start.mesh.facets.size(); ++f) {
    const Triangle& t = start.mesh.facets[f];
    for (int k = 0; k < 3; ++k) {
      films[edge_key(t[k], t[(k + 1) % 3])].push_back(
          start.mesh.facet_label[f]);
    }
  }
  std::vector<int> ends(start.mesh.points.size(), 0);  // of lines, by vertex
  std::vector<int> lengths(system.films.size(), 0);    // edges, by film
  for (const auto& [edge, there] : films) {
    ASSERT_LE(there.size(), 3U);
    if (there.size() == 3) {
      ++lengths[*std::max_element(there.begin(), there.end())];
      ++ends[edge[0]];
      ++ends[edge[1]];
    } else if (there.size() == 1) {
      EXPECT_EQ(start.vertices[edge[0]].kind, films::VertexKind::OnCurve);
      EXPECT_EQ(start.vertices[edge[1]].kind, films::VertexKind::OnCurve);
    }
  }
  for (std::size_t film = 1; film < lengths.size(); ++film) {
    EXPECT_GT(lengths[film], 0) << system.films[film].name;
  }
  for (const films::JoinEnd& end : films::join_ends(system)) {
    const bool is_there = std::any_of(
        start.mesh.points.begin(), start.mesh.points.end(), [&](const Vec3& p) {
          return (p - end.place).norm() < 1e-9 &&
                 ends[&p - start.mesh.points.data()] > 0;
        });
    EXPECT_TRUE(is_there) << end.place.transpose();
  }
}

// Also where lines begin at a fifth of an edge from each other: fins whose feet
// may lean, of which some share a corner.
TEST(JoinFilms, EveryLineRunsFromEndToEnd) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int draw = 0; draw < 60; ++draw) {
    SCOPED_TRACE(draw);
    films::FilmSystem system = tube();
    const int count = 1 + static_cast<int>(5.0 * share(random));
    const double first = kTurn * share(random);
    const double apart =
        std::min(0.9 * kTurn / count, 0.15 * std::pow(10.0, share(random)));
    const bool share_corners = share(random) < 0.3;
    double low = first;
    for (int k = 0; k < count; ++k) {
      low = share_corners && k % 2 == 1 ? low : first + apart * k;
      add_fin(system, low, first + apart * (k + 0.4 * share(random)));
    }
    const double edge = 0.1 * std::pow(8.0, share(random));
    expect_lines(system, start::build_start(system, edge));
  }
}

// A shelf needs three edges of its film about it.
TEST(JoinFilms, AClosedLineFindsItsWayOnAnyStart) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int draw = 0; draw < 30; ++draw) {
    SCOPED_TRACE(draw);
    films::FilmSystem system = tube();
    system.curves.push_back(
        {"shelf", curves::Circle{Vec3(0.1 * share(random), 0.1 * share(random),
                                      (0.5 + 0.2 * share(random)) * kHigh),
                                 Vec3(0.2 * share(random), 0, 1),
                                 1.0 + 0.1 * share(random)}});
    system.curves.back().free = true;
    system.films.push_back({"shelf", films::FilmKind::Disk, {"shelf"}, 0.3});
    system.films.back().joins = {"skin"};
    expect_lines(
        system,
        start::build_start(system, std::pow(10.0, 0.5 * share(random) - 0.5)));
  }
}

// The numbers of a case are rounded.
TEST(JoinFilms, EndsAtTheCornerThatItIsDrawnNear) {
  films::FilmSystem system;
  system.curves = {
      {"frame",
       curves::Polygon{{Vec3(-1, -1, 0), Vec3(0, -1, 0.2), Vec3(1, -1, 0),
                        Vec3(1, 1, 0), Vec3(0, 1, 0.2), Vec3(-1, 1, 0)}}}};
  system.films = {{"skin", films::FilmKind::Disk, {"frame"}, 1.0}};
  constexpr double kOff = 1e-5;
  add_plate(system,
            {Vec3(kOff, -1, 0.2), Vec3(0, 1, 0.2 - kOff), Vec3(0, 1, 1),
             Vec3(0, -1, 1)},
            {0});
  const films::FilmComplex start = start::build_start(system, 0.4);
  double shortest = 1.0;
  for (const Triangle& t : start.mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      shortest = std::min(
          shortest,
          (start.mesh.points[t[k]] - start.mesh.points[t[(k + 1) % 3]]).norm());
    }
  }
  EXPECT_GT(shortest, 0.05);
}

// Amid a plate that passes from a film to the next its corner is where it is
// drawn on the curve that holds both.
TEST(JoinFilms, PassesToTheNextFilmWhereItIsDrawn) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int draw = 0; draw < 20; ++draw) {
    films::FilmSystem system = tube();
    system.curves.push_back({"top", curves::Circle{2.0 * kHigh * Vec3::UnitZ(),
                                                   Vec3::UnitZ(), 1.0}});
    system.films.push_back(
        {"upper", films::FilmKind::Loft, {"high", "top"}, 1.0});
    const double at = kTurn * share(random);
    const double far = at + 0.4 * kTurn + 0.2 * kTurn * share(random);
    add_plate(system,
              {place(at, 1.0, 0.0), place(far, 1.0, 0.0),
               place(far, 0.95, kHigh), place(far, 1.0, 2.0 * kHigh),
               place(at, 1.0, 2.0 * kHigh), place(at, 0.97, kHigh)},
              {1, 2, 4, 5});
    system.films.back().joins = {"skin", "upper"};
    const films::FilmComplex start =
        start::build_start(system, 0.2 + 0.4 * share(random));
    for (const double angle : {at, far}) {
      double nearest = 1.0;
      for (const Vec3& p : start.mesh.points) {
        nearest = std::min(nearest, (p - place(angle, 1.0, kHigh)).norm());
      }
      EXPECT_LT(nearest, 1e-7) << draw;
    }
  }
}

}  // namespace
}  // namespace meniscus::join_films_test
