// Walls of films that meet: closed, as thick as asked, rounded, and a smooth
// map of their films.
#include "evolve/walls/wall_model.h"

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/walls/facet_probe.h"
#include "tests/support/sheet_shapes.h"
#include "tests/support/wall_films.h"

namespace meniscus::wall_model_test {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kPromisedThickness =
    0.05;                                // of the thickness away from junctions
constexpr double kWallRounding = 1e-11;  // of sums over some thousand facets
constexpr double kDifference = 1e-6;     // central differences, step 1e-6

SurfaceMesh flat(const std::string& name, const Vec3& o, const Vec3& u,
                 const Vec3& v, int n = 8) {
  return shapes::patch(
      [&](double a, double b) { return Vec3(o + a * u + b * v); },
      {.rows = n, .columns = n, .jitter = 0.0}, name);
}

/// Films around the y axis, at these angles [degree], of width 1 and length 2.
SurfaceMesh fan(const std::vector<double>& angles, int n = 8) {
  std::vector<SurfaceMesh> films;
  for (const double degree : angles) {
    const double a = degree * kHalfTurn / 180.0;
    films.push_back(flat("film" + std::to_string(films.size()), Vec3::Zero(),
                         {std::cos(a), 0, std::sin(a)}, {0, 2, 0}, n));
  }
  return joined_films(films);
}

/// Six films from the edges of a tetrahedron to its middle.
SurfaceMesh tetrahedral(int n = 8) {
  const std::array<Vec3, 4> corner = {Vec3(1, 1, 1), Vec3(1, -1, -1),
                                      Vec3(-1, 1, -1), Vec3(-1, -1, 1)};
  std::vector<SurfaceMesh> films;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      SurfaceMesh film;
      film.labels = {"film" + std::to_string(films.size())};
      std::map<std::pair<int, int>, int> id;
      for (int a = 0; a <= n; ++a) {
        for (int b = 0; a + b <= n; ++b) {
          id[{a, b}] = static_cast<int>(film.points.size());
          film.points.push_back((a * corner[i] + b * corner[j]) / n);
        }
      }
      for (int a = 0; a < n; ++a) {
        for (int b = 0; a + b < n; ++b) {
          film.facets.push_back({id[{a, b}], id[{a + 1, b}], id[{a, b + 1}]});
          if (a + b + 2 <= n) {
            film.facets.push_back(
                {id[{a + 1, b}], id[{a + 1, b + 1}], id[{a, b + 1}]});
          }
        }
      }
      film.facet_label.assign(film.facets.size(), 0);
      films.push_back(std::move(film));
    }
  }
  return joined_films(films);
}

/// A number that follows the design.
PlaceField uniform(double value) {
  PlaceField field = Expression::parse("t", {"x", "y", "z", "t"});
  field.names = {"t"};
  field.numbers = VectorX::Constant(1, value);
  return field;
}

walls::WallSpec spec(const SurfaceMesh& mesh, double thickness,
                     std::optional<double> fillet = std::nullopt) {
  return {.name = "web",
          .films = mesh.labels,
          .thickness = uniform(thickness),
          .side = walls::WallSide::Both,
          .fillet = fillet,
          .region = 0};
}

struct Made {
  walls::WallFilms films;
  std::vector<walls::WallSpec> specs;
  walls::WallModel model;
};

Made make(const SurfaceMesh& mesh, double thickness, int levels = 1,
          std::optional<double> fillet = std::nullopt) {
  walls::WallFilms films = wall_films_of(mesh, levels, thickness);
  std::vector<walls::WallSpec> specs = {spec(mesh, thickness, fillet)};
  walls::WallModel model(films, specs);
  return {std::move(films), std::move(specs), std::move(model)};
}

/// Largest relative error of the thickness at places of one film's front that
/// `away` accepts: to the nearest place of its back.
template <class Away>
double worst_thickness(const SurfaceMesh& wall, const std::string& film,
                       double thickness, const Away& away,
                       double* least = nullptr) {
  SurfaceMesh back = wall;
  back.facets.clear();
  const int front = wall.label_of(film);
  const int behind = wall.label_of(film + "/back");
  for (std::size_t f = 0; f < wall.facets.size(); ++f) {
    if (wall.facet_label[f] == behind) {
      back.facets.push_back(wall.facets[f]);
    }
  }
  const walls::FacetProbe probe(back.points, back.facets);
  double worst = 0.0;
  for (std::size_t f = 0; f < wall.facets.size(); ++f) {
    const Triangle& t = wall.facets[f];
    const Vec3 p =
        (wall.points[t[0]] + wall.points[t[1]] + wall.points[t[2]]) / 3.0;
    if (wall.facet_label[f] != front) {
      continue;
    }
    const double ratio = probe.nearest(p).distance / thickness;
    if (away(p)) {
      worst = std::max(worst, std::abs(ratio - 1.0));
    }
    if (least != nullptr) {
      *least = std::min(*least, ratio);
    }
  }
  return worst;
}

/// Least part of the thickness anywhere, and the largest relative error where
/// `away` says so.
template <class Away>
std::pair<double, double> thickness_range(const SurfaceMesh& wall,
                                          const std::string& film,
                                          double thickness, const Away& away) {
  double least = 1.0;
  const double worst = worst_thickness(wall, film, thickness, away, &least);
  return {least, worst};
}

/// Largest distance of a point to the nearest of the others.
double farthest(const Points& points, const Points& others) {
  double worst = 0.0;
  for (const Vec3& p : points) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& q : others) {
      least = std::min(least, (p - q).norm());
    }
    worst = std::max(worst, least);
  }
  return worst;
}

struct Junction {
  const char* name;
  std::vector<double> angles;
  int levels;
};

class WallsAtALine : public testing::TestWithParam<Junction> {};

TEST_P(WallsAtALine, AreClosedAndAsThickAsAsked) {
  const double t = 0.12;
  const SurfaceMesh mesh = fan(GetParam().angles);
  const Made made = make(mesh, t, GetParam().levels);
  const walls::ThickWall& wall = made.model.walls().at(0);
  EXPECT_TRUE(wall.findings.empty()) << summary(wall.findings);
  // Of every film 2 x 1 x t, less what overlaps at the line, plus fillets.
  const auto films = static_cast<double>(mesh.labels.size());
  EXPECT_NEAR(wall.volume, films * 2.0 * t, 2.5 * films * t * t);
  for (const std::string& film : mesh.labels) {
    EXPECT_LT(worst_thickness(wall.surface, film, t,
                              [&](const Vec3& p) {
                                return std::hypot(p.x(), p.z()) > 2.0 * t;
                              }),
              kPromisedThickness)
        << film;
  }
  const QuadraticSurface surface = made.model.surface(
      made.films.mesh.points, made.model.numbers(made.specs));
  EXPECT_TRUE(check_surface(surface.base).empty())
      << summary(check_surface(surface.base));
}

INSTANTIATE_TEST_SUITE_P(Junctions, WallsAtALine,
                         // A fillet of t/2 between films at 50 degrees ends
                         // 2.14 t from their line, at 2 t it is 2 % thicker.
                         testing::Values(Junction{"T", {0, 90, 180}, 1},
                                         Junction{"Y", {0, 120, 240}, 2},
                                         Junction{"X", {0, 90, 180, 270}, 1},
                                         Junction{"sharp", {0, 60, 200}, 1},
                                         Junction{"one sided", {0, 50, 100}, 2},
                                         Junction{"coarse", {0, 120, 240}, 0}),
                         [](const auto& junction) {
                           std::string name = junction.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

struct RandomFan {
  std::vector<double> angles;  // [degree]
  std::vector<double> thickness;
  std::vector<double> fillets;
  int rows = 0;  // of facets from line to rim, of length 1
  std::string text;
};

struct RandomBounds {
  double least_angle = 0.0;  // between films [degree]
  double most_ratio = 0.0;   // of thicknesses
  int most_rows = 0;
};

RandomFan random_fan(std::mt19937& random, const RandomBounds& bounds) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const int count = 2 + static_cast<int>(3.0 * part(random));
  std::vector<double> gaps;
  for (int k = 0; k < count; ++k) {
    gaps.push_back(part(random));
  }
  const double all = std::accumulate(gaps.begin(), gaps.end(), 0.0);
  RandomFan fan;
  for (double at = 360.0 * part(random); const double gap : gaps) {
    fan.angles.push_back(at);
    at += bounds.least_angle + (360.0 - bounds.least_angle * count) * gap / all;
  }
  fan.rows = 4 + static_cast<int>((bounds.most_rows - 4) * part(random));
  const double most = 0.04 * std::pow(4.0, part(random));
  for (const double angle : fan.angles) {
    const double t = most * std::pow(bounds.most_ratio, -part(random));
    fan.thickness.push_back(t);
    fan.fillets.push_back(0.8 * t * part(random));
    fan.text += fmt::format(", {:.3g} at {:.3g} (fillet {:.3g})", t, angle,
                            fan.fillets.back());
  }
  fan.text = fmt::format("edge {:.3g}{}", 1.0 / fan.rows, fan.text);
  return fan;
}

/// Walls of `mesh`, its films those of `fan`: closed, nowhere thinner than 0.9
/// of what was asked, and as thick as that further from the line than four
/// times the thickest of them, where facets are shorter than ten times it.
void expect_walls(const SurfaceMesh& mesh, const RandomFan& fan,
                  const std::function<double(const Vec3&)>& from_line) {
  constexpr double kLeastOfAsked = 0.9;
  walls::WallFilms films = wall_films_of(mesh, 1, 0.1);
  std::vector<walls::WallSpec> specs;
  for (std::size_t k = 0; k < fan.angles.size(); ++k) {
    films.wall[k] = static_cast<int>(k);
    specs.push_back(spec(mesh, fan.thickness[k], fan.fillets[k]));
    specs.back().films = {mesh.labels[k]};
  }
  films.asked = fan.thickness;
  films.region.assign(specs.size(), 0);
  const walls::WallModel model(films, specs);
  const walls::ThickWall& wall = model.walls().at(0);
  EXPECT_TRUE(wall.findings.empty()) << summary(wall.findings);
  const double most =
      *std::max_element(fan.thickness.begin(), fan.thickness.end());
  for (std::size_t k = 0; k < specs.size(); ++k) {
    const auto [least, worst] = thickness_range(
        wall.surface, mesh.labels[k], fan.thickness[k], [&](const Vec3& p) {
          return from_line(p) > 4.0 * most && fan.rows * fan.thickness[k] > 0.1;
        });
    EXPECT_GT(least, kLeastOfAsked) << mesh.labels[k];
    EXPECT_LT(worst, kPromisedThickness) << mesh.labels[k];
  }
}

// Whatever angles, thicknesses, fillets and edges, on a line that ends on rims.
TEST(WallsAtALine, OfRandomThicknessAndEdge) {
  std::mt19937 random(20);
  for (int trial = 0; trial < 12; ++trial) {
    const RandomFan films = random_fan(
        random, {.least_angle = 50.0, .most_ratio = 2.0, .most_rows = 24});
    SCOPED_TRACE(fmt::format("trial {}: {}", trial, films.text));
    expect_walls(fan(films.angles, films.rows), films,
                 [](const Vec3& p) { return std::hypot(p.x(), p.z()); });
  }
}

// The same around a circle, where there are no such ends: thicknesses may
// differ eightfold and angles be sharp.
TEST(WallsAtALine, AroundACircle) {
  constexpr double kRadius = 1.6;
  std::mt19937 random(21);
  for (int trial = 0; trial < 6; ++trial) {
    const RandomFan films = random_fan(
        random, {.least_angle = 30.0, .most_ratio = 8.0, .most_rows = 14});
    SCOPED_TRACE(fmt::format("trial {}: {}", trial, films.text));
    std::vector<SurfaceMesh> parts;
    for (const double degree : films.angles) {
      const double a = degree * kHalfTurn / 180.0;
      parts.push_back(shapes::patch(
          [&](double around, double out) {
            const double r = kRadius + out * std::cos(a);
            const double b = 2.0 * kHalfTurn * around;
            return Vec3(r * std::cos(b), r * std::sin(b), out * std::sin(a));
          },
          {.rows = films.rows, .columns = 8 * films.rows, .around = true},
          "film" + std::to_string(parts.size())));
    }
    expect_walls(joined_films(parts), films, [](const Vec3& p) {
      return std::hypot(std::hypot(p.x(), p.y()) - kRadius, p.z());
    });
  }
}

TEST(WallsAtAPoint, OfFourLinesAreClosed) {
  const double t = 0.08;
  const SurfaceMesh mesh = tetrahedral();
  for (const int levels : {0, 1}) {
    const Made made = make(mesh, t, levels);
    const walls::ThickWall& wall = made.model.walls().at(0);
    EXPECT_TRUE(wall.findings.empty()) << summary(wall.findings);
    EXPECT_NEAR(wall.volume, 6.0 * std::sqrt(2.0) * t, 0.12 * wall.volume);
  }
}

/// As `mesh`, with the second label of each pair called as the first.
SurfaceMesh with_one_label(SurfaceMesh mesh, int first, int second) {
  for (int& label : mesh.facet_label) {
    label = label == second ? first : label;
  }
  mesh.labels.erase(mesh.labels.begin() + second);
  for (int& label : mesh.facet_label) {
    label -= label > second ? 1 : 0;
  }
  return mesh;
}

// Lines end at points where they meet others, and on rims: their wall points
// move along them there, and those behind keep their order whatever the edges.
TEST(WallsAtAPoint, AreClosedAtShortEdges) {
  constexpr double kShortestAtSlantedRim = 0.3;  // of t: docs/decisions/0016
  const Vec3 x = Vec3::UnitX();
  const Vec3 y = Vec3::UnitY();
  const Vec3 z = Vec3::UnitZ();
  const Vec3 o = Vec3::Zero();
  for (const int n : {8, 24}) {
    const SurfaceMesh corner = joined_films(
        {flat("a", o, x, y, n), flat("b", o, y, z, n), flat("c", o, z, x, n)});
    // A line of two films in one plane that ends on a rib across it.
    const SurfaceMesh halves =
        joined_films({flat("left", o, -x, y, n), flat("low", o, x, y, n),
                      flat("high", y, x, y, n), flat("left2", y, -x, y, n),
                      flat("rib", o, z, y, n), flat("rib2", y, z, y, n)});
    const SurfaceMesh gusset =
        joined_films({flat("plate", o, x, y, n), flat("other", o, -x, y, n),
                      flat("slanted", o, Vec3(0, 1, 1), y, n)});
    const SurfaceMesh crossing = joined_films(
        {flat("a", o, x, y, n), flat("b", o, -x, y, n), flat("c", o, x, -y, n),
         flat("d", o, -x, -y, n), flat("e", o, z, x, n), flat("f", o, z, -x, n),
         flat("g", o, z, y, n), flat("h", o, z, -y, n)});
    const SurfaceMesh one = with_one_label(fan({0, 90, 180}, n), 0, 2);
    int k = 0;
    for (const SurfaceMesh& mesh : {corner, halves, gusset, crossing, one}) {
      for (const double t : {0.06, 0.12}) {
        for (const double fillet : {0.0, 0.06}) {
          if (k == 2 && 0.5 / n < kShortestAtSlantedRim * t) {
            continue;
          }
          SCOPED_TRACE(fmt::format("shape {}, edge {:.3g}, wall {}, fillet {}",
                                   k, 0.5 / n, t, fillet));
          const Made made = make(mesh, t, 1, fillet);
          const walls::ThickWall& wall = made.model.walls().at(0);
          EXPECT_TRUE(wall.findings.empty()) << summary(wall.findings);
        }
      }
      ++k;
    }
  }
  const Made made = make(tetrahedral(24), 0.16, 0);
  EXPECT_TRUE(made.model.walls().at(0).findings.empty())
      << summary(made.model.walls().at(0).findings);
}

// The middle of an arc of radius r between sides h off two films at an angle:
// (h + r) / sin(angle / 2) - r from their line.
TEST(Fillets, AreArcs) {
  const double t = 0.12;
  for (const double r : {0.0, 0.06, 0.15}) {
    const Made made = make(fan({0, 90, 180, 270}, 24), t, 1, r);
    const walls::ThickWall& wall = made.model.walls().at(0);
    EXPECT_TRUE(wall.findings.empty()) << summary(wall.findings);
    const double expected = (0.5 * t + r) * std::sqrt(2.0) - r;
    double least = 1.0;
    double worst = 0.0;
    const double centre = 0.5 * t + r;
    for (std::size_t p = 0; p < wall.surface.points.size(); ++p) {
      const Vec3& x = wall.surface.points[p];
      if (wall.trace[p].vertex < 0) {
        continue;
      }
      const Vec3 q(std::abs(x.x()), x.y(), std::abs(x.z()));
      least = std::min(least, std::hypot(q.x(), q.z()));
      if (q.x() < centre && q.z() < centre) {
        worst = std::max(
            worst, std::abs(std::hypot(q.x() - centre, q.z() - centre) - r));
      }
    }
    EXPECT_NEAR(least, expected, 1e-9);
    EXPECT_LT(worst, 1e-9);
  }
}

/// A plate in z = 0 with a square hole, from whose edges a column of four films
/// leans outwards on its way down. `n` edges per half width of the hole.
SurfaceMesh brim_on_column(double lean, int n) {
  SurfaceMesh brim;
  brim.labels = {"brim"};
  std::map<std::pair<int, int>, int> id;
  const auto point = [&](int i, int j) {
    const auto [at, fresh] =
        id.try_emplace({i, j}, static_cast<int>(brim.points.size()));
    if (fresh) {
      brim.points.push_back(Vec3(i, j, 0) / n);
    }
    return at->second;
  };
  for (int i = -2 * n; i < 2 * n; ++i) {
    for (int j = -2 * n; j < 2 * n; ++j) {
      if (i < -n || i >= n || j < -n || j >= n) {
        const int a = point(i, j);
        const int b = point(i + 1, j);
        const int c = point(i + 1, j + 1);
        const int d = point(i, j + 1);
        brim.facets.push_back({a, b, c});
        brim.facets.push_back({a, c, d});
      }
    }
  }
  brim.facet_label.assign(brim.facets.size(), 0);
  std::vector<SurfaceMesh> films = {brim};
  for (int k = 0; k < 4; ++k) {
    const Mat3 turn =
        Eigen::AngleAxisd(0.5 * kHalfTurn * k, Vec3::UnitZ()).matrix();
    films.push_back(shapes::patch(
        [&](double u, double v) -> Vec3 {
          const double wide = 1.0 + lean * v;
          return turn * Vec3(wide, (2.0 * u - 1.0) * wide, -2.0 * v);
        },
        {.rows = 2 * n, .columns = 2 * n, .jitter = 0.0},
        "side" + std::to_string(k)));
  }
  return joined_films(films);
}

// Around the column's corner a ball of radius r rolls from side to side, below
// the brim and beside the corner's edge: the middle of its arc there.
TEST(Fillets, GoAroundTheEdgesOfAColumn) {
  const double t = 0.3;
  for (const double r : {0.05, 0.15}) {
    const Made made = make(brim_on_column(0.0, 8), t, 0, r);
    const Points& points = made.model.walls().at(0).surface.points;
    const double way = r * (1.0 - std::sqrt(0.5));
    const double out = 1.0 + 0.5 * t + way * std::sqrt(0.5);
    const Points corners = {{out, out, -0.5 * t - way},
                            {-out, out, -0.5 * t - way},
                            {out, -out, -0.5 * t - way},
                            {-out, -out, -0.5 * t - way}};
    EXPECT_LT(farthest(corners, points), 1e-9);
  }
}

// Under the brim, outside of the column, all moves away from the column's
// corner; what lagged behind there would hang over.
TEST(WallModel, KeepsFacetsInOrderAroundAColumn) {
  for (const double lean : {0.0, 0.3}) {
    for (const int n : {4, 8, 12, 16}) {
      const Made made =
          make(brim_on_column(lean, n), 0.3, 0, lean == 0.0 ? 0.15 : 0.1);
      const walls::ThickWall& wall = made.model.walls().at(0);
      EXPECT_TRUE(wall.findings.empty()) << summary(wall.findings);
      const SurfaceMesh& mesh = wall.surface;
      double least = 1.0;  // of a facet's normal, downwards
      for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        const std::string& label = mesh.labels[mesh.facet_label[f]];
        const Vec3 area = area_vector2(mesh, static_cast<int>(f));
        const Triangle& t = mesh.facets[f];
        const double z =
            (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]).z() /
            3.0;
        if (label.substr(0, 4) == "brim" && label.find("rim:") == label.npos &&
            z < 0.0) {
          least = std::min(least, -area.normalized().z());
        }
      }
      EXPECT_GT(least, 0.0) << "lean " << lean << ", " << n << " edges";
    }
  }
}

// A brim hardly twice as wide as its walls are thick: its outer corners stay,
// and points of its rim do not run past them.
TEST(WallModel, KeepsCornersOfANarrowBrim) {
  for (const auto& [thickness, n] :
       {std::pair(0.47, 3), std::pair(0.47, 5), std::pair(0.55, 3)}) {
    const Made made = make(brim_on_column(0.15, n), thickness, 1);
    const walls::ThickWall& wall = made.model.walls().at(0);
    EXPECT_TRUE(wall.findings.empty())
        << thickness << ", " << n << ": " << summary(wall.findings);
    const Points corners = {{2, 2, -0.5 * thickness},
                            {-2, 2, -0.5 * thickness},
                            {2, -2, -0.5 * thickness},
                            {-2, -2, -0.5 * thickness}};
    EXPECT_LT(farthest(corners, wall.surface.points), 1e-9);
  }
}

TEST(WallModel, TurnsWithItsFilm) {
  const Made made = make(fan({0, 90, 200}), 0.1);
  const Mat3 turn =
      Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Points turned = made.films.mesh.points;
  for (Vec3& p : turned) {
    p = turn * p + Vec3(5, 6, 7);
  }
  const std::vector<VectorX> t = made.model.numbers(made.specs);
  const Points before = made.model.fine(made.films.mesh.points, t).points;
  const Points after = made.model.fine(turned, t).points;
  for (std::size_t p = 0; p < before.size(); ++p) {
    EXPECT_LT((after[p] - turn * before[p] - Vec3(5, 6, 7)).norm(),
              kWallRounding);
  }
}

TEST(WallModel, DoublesWithItsThickness) {
  const Made made = make(fan({0, 90, 180}), 0.05);
  const Points& x = made.films.mesh.points;
  const std::vector<VectorX> t = made.model.numbers(made.specs);
  const double once = enclosed_volume(made.model.fine(x, t));
  const double twice = enclosed_volume(made.model.fine(x, {2.0 * t[0]}));
  const double again = make(fan({0, 90, 180}), 0.10).model.walls().at(0).volume;
  EXPECT_NEAR(twice, again, 0.01 * again);
  EXPECT_GT(twice, 1.9 * once);
}

TEST(WallModel, TransposesItsDerivative) {
  const SurfaceMesh mesh = fan({0, 100, 190}, 4);
  std::vector<walls::WallSpec> specs = {spec(mesh, 0.1)};
  PlaceField& thickness = specs[0].thickness;
  thickness = Expression::parse("t*(1+0.3*x*s)", {"x", "y", "z", "t", "s"});
  thickness.names = {"t", "s"};
  thickness.numbers = VectorX::Constant(2, 0.1);
  thickness.numbers[1] = 0.7;
  const walls::WallFilms films = wall_films_of(mesh, 1, 0.1);
  const Made made = {films, specs, walls::WallModel(films, specs)};
  const std::vector<VectorX> t = {1.2 * thickness.numbers};
  Points film = made.films.mesh.points;
  Points rate(film.size());
  for (std::size_t v = 0; v < film.size(); ++v) {
    const auto k = static_cast<double>(v);
    rate[v] = Vec3(std::sin(k), std::sin(2.0 * k), std::sin(3.0 * k));
    film[v] += 0.02 * Vec3(std::cos(k), std::cos(2.0 * k), std::cos(3.0 * k));
  }
  const auto objective = [&](const Points& x,
                             const std::vector<VectorX>& numbers) {
    const QuadraticSurface s = made.model.surface(x, numbers);
    double sum = 0.0;
    for (std::size_t i = 0; i < s.base.points.size(); ++i) {
      sum += std::sin(1.0 * i) * s.base.points[i].dot(Vec3(1, 2, 3));
    }
    for (std::size_t i = 0; i < s.mid.size(); ++i) {
      sum += std::cos(1.0 * i) * s.mid[i].dot(Vec3(3, -1, 2));
    }
    return sum;
  };
  const QuadraticSurface s = made.model.surface(film, t);
  Points by_corners;
  Points by_mid;
  for (std::size_t i = 0; i < s.base.points.size(); ++i) {
    by_corners.push_back(std::sin(1.0 * i) * Vec3(1, 2, 3));
  }
  for (std::size_t i = 0; i < s.mid.size(); ++i) {
    by_mid.push_back(std::cos(1.0 * i) * Vec3(3, -1, 2));
  }
  const walls::WallGradient gradient =
      made.model.transpose(film, t, by_corners, by_mid);
  const double step = 1e-6;
  Points ahead = film;
  Points behind = film;
  double exact = 0.0;
  for (std::size_t v = 0; v < film.size(); ++v) {
    ahead[v] += step * rate[v];
    behind[v] -= step * rate[v];
    exact += gradient.film[v].dot(rate[v]);
  }
  const double by_film =
      (objective(ahead, t) - objective(behind, t)) / (2.0 * step);
  EXPECT_NEAR(exact, by_film, kDifference * std::abs(by_film));
  const VectorX way(VectorX::LinSpaced(2, 1.0, 0.4));
  const double by_thickness = (objective(film, {t[0] + step * way}) -
                               objective(film, {t[0] - step * way})) /
                              (2.0 * step);
  EXPECT_NEAR(gradient.thickness[0].dot(way), by_thickness,
              kDifference * std::abs(by_thickness));
}

TEST(WallModel, SplitsItsFacets) {
  Made made = make(fan({0, 90, 180}, 4), 0.2, 2);
  const std::vector<VectorX> t = made.model.numbers(made.specs);
  const Points& x = made.films.mesh.points;
  const std::size_t before = made.model.surface(x, t).base.facets.size();
  std::vector<char> marked(before, 0);
  for (std::size_t f = 0; f < before; f += 3) {
    marked[f] = 1;
  }
  made.model.split_facets(marked);
  const SurfaceMesh split = made.model.surface(x, t).base;
  EXPECT_GT(split.facets.size(), before);
  EXPECT_TRUE(check_surface(split).empty()) << summary(check_surface(split));
}

// Point by point, and what was measured; skew cells of the rims may be cut
// along the other diagonal.
TEST(WallModel, OfACatenoidIsWhatThickenMakes) {
  constexpr double kDiagonals = 1e-4;  // of the volume
  const SurfaceMesh film =
      shapes::catenoid_sheet(0.6, {.rows = 8, .columns = 32, .around = true});
  for (const double t : {0.1, 0.4}) {
    const walls::ThickWall plain =
        walls::thicken(film, {.thickness = Expression(t)});
    const Made made = make(film, t, 0);
    const walls::ThickWall& wall = made.model.walls().at(0);
    EXPECT_TRUE(wall.findings.empty()) << summary(wall.findings);
    EXPECT_EQ(wall.surface.points.size(), plain.surface.points.size());
    EXPECT_LT(farthest(wall.surface.points, plain.surface.points),
              kWallRounding);
    EXPECT_NEAR(wall.volume, plain.volume, kDiagonals * plain.volume);
    EXPECT_NEAR(wall.thinnest.value, plain.thinnest.value, kWallRounding);
    EXPECT_NEAR(wall.safe.value, plain.safe.value, kWallRounding);
  }
}

// A skin whose material lies on one side keeps its other side as the film has
// it, also where a rib meets it there or there.
TEST(WallModel, OfOneSideMeetsOthers) {
  const double t = 0.1;
  for (const double rib : {70.0, 250.0}) {
    const SurfaceMesh mesh = fan({0, rib, 180}, 16);
    std::vector<walls::WallSpec> specs = {spec(mesh, t), spec(mesh, t)};
    specs[0].films = {"film0", "film2"};
    specs[0].side = walls::WallSide::Inside;
    specs[1].films = {"film1"};
    walls::WallFilms films = wall_films_of(mesh, 1, t);
    films.wall = {0, 1, 0};
    films.region = {0, 0};
    films.asked = {t, t};
    for (std::size_t f = 0; f < films.mesh.facets.size(); ++f) {
      if (films.mesh.facet_label[f] == 2) {  // its front up, as film0's
        std::swap(films.mesh.facets[f][1], films.mesh.facets[f][2]);
      }
    }
    const walls::WallModel model(films, specs);
    const walls::ThickWall& wall = model.walls().at(0);
    EXPECT_TRUE(wall.findings.empty()) << summary(wall.findings);
    double low = 0.0;
    double high = 0.0;
    int seen = 0;
    for (std::size_t f = 0; f < wall.surface.facets.size(); ++f) {
      const std::string& label =
          wall.surface.labels[wall.surface.facet_label[f]];
      for (const int v : wall.surface.facets[f]) {
        const Vec3& p = wall.surface.points[v];
        // The rib's side is bent there, the other one is the film's.
        const bool of_rib = rib < 180.0 ? label.size() == 5 : label.size() > 5;
        if (of_rib && std::abs(p.x()) < 4.0 * t) {
          continue;
        }
        seen += label.find("rim") == std::string::npos ? 1 : 0;
        if (label == "film0" || label == "film2") {
          low = std::max(low, std::abs(p.z()));
        } else if (label == "film0/back" || label == "film2/back") {
          high = std::max(high, std::abs(p.z() + t));
        }
      }
    }
    EXPECT_GT(seen, 1000);
    EXPECT_LT(low, kWallRounding) << rib;
    EXPECT_LT(high, kWallRounding) << rib;
    // The rib's share, less what of it is in the skin.
    EXPECT_NEAR(wall.volume, 2.0 * 2.0 * t + 2.0 * t, 3.0 * t * t);
  }
}

}  // namespace
}  // namespace meniscus::wall_model_test
