// Solids of exact faces: closed at any edge length, their vertices on the
// surfaces, their volumes by Richardson's rule; films at their rims; moved.
#include "evolve/start/solid_start.h"

#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/geometry/exact_points.h"
#include "core/geometry/mesh_checks.h"
#include "evolve/films/body_sides.h"
#include "evolve/films/solid_frame.h"
#include "evolve/frozen/film_model.h"
#include "evolve/groom/refine.h"
#include "evolve/start/start_complex.h"
#include "tests/support/check_complex.h"

namespace meniscus::solid_start_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWholeTurn = 2.0 * kPi;
constexpr double kOnSurface = 1e-12;  // rounding of a few products
// What Richardson's rule leaves with 36 pieces to a turn; of fourth order.
constexpr double kFourth = 2.5e-4;

ExactEllipse circle(const Vec3& center, double radius) {
  return {center, radius * Vec3::UnitX(), radius * Vec3::UnitY()};
}

ExactFrame at_height(double z) { return {z * Vec3::UnitZ()}; }

/// Between circles of z = 0 and z = height, all around; its seam is `seam`.
std::vector<ExactUse> around(int low, int seam, int high, double top) {
  return {{low, true, Vec2(0, 0)},
          {seam, true, Vec2(kWholeTurn, 0)},
          {high, false, Vec2(kWholeTurn, top)},
          {seam, false, Vec2(0, top)}};
}

struct Sample {
  std::string name;
  ExactShape shape;
  double volume = 0.0;
};

/// Of radii 2 and 1.
Sample pipe(double height) {
  ExactShape s;
  for (const double radius : {2.0, 1.0}) {
    const int first = static_cast<int>(s.vertices.size());
    const int edge = static_cast<int>(s.edges.size());
    for (const double z : {0.0, height}) {
      const int at = static_cast<int>(s.vertices.size());
      s.vertices.emplace_back(radius, 0, z);
      s.edges.push_back(
          {"", at, at, circle(z * Vec3::UnitZ(), radius), 0, kWholeTurn});
    }
    s.edges.push_back({"", first, first + 1,
                       ExactLine{s.vertices[first], Vec3::UnitZ()}, 0, height});
    s.faces.push_back({radius > 1.0 ? "outer" : "bore",
                       ExactCylinder{ExactFrame(), radius},
                       radius > 1.0,
                       {around(edge, edge + 2, edge + 1, height)}});
  }
  for (const int top : {0, 1}) {
    s.faces.push_back({top == 1 ? "top" : "bottom",
                       ExactPlane{at_height(top * height)},
                       top == 1,
                       {{{3 + top, false}}, {{top, true}}}});
  }
  return {"pipe", s, 3.0 * kPi * height};
}

/// To a tip, upon radius 1.
Sample cone(double height) {
  ExactShape s;
  const double slope = std::hypot(height, 1.0);
  s.vertices = {Vec3(1, 0, 0), Vec3(0, 0, height)};
  s.edges = {{"", 0, 0, circle(Vec3::Zero(), 1.0), 0, kWholeTurn},
             {"", 0, 1, ExactLine{Vec3(1, 0, 0), Vec3(-1, 0, height) / slope},
              0, slope}};
  s.faces = {{"cone",
              ExactCone{ExactFrame(), 1.0, -std::atan2(1.0, height)},
              true,
              {{{0, true, Vec2(0, 0)},
                {1, true, Vec2(kWholeTurn, 0)},
                {1, false, Vec2(0, slope)}}}},
             {"base", ExactPlane{}, false, {{{0, true}}}}};
  return {"cone", s, kPi * height / 3.0};
}

Sample dome() {
  ExactShape s;
  s.vertices = {Vec3(1, 0, 0), Vec3(0, 0, 1)};
  s.edges = {
      {"", 0, 0, circle(Vec3::Zero(), 1.0), 0, kWholeTurn},
      {"", 0, 1, ExactEllipse{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ()}, 0,
       0.5 * kPi}};
  s.faces = {{"dome",
              ExactSphere{ExactFrame(), 1.0},
              true,
              {{{0, true, Vec2(0, 0)},
                {1, true, Vec2(kWholeTurn, 0)},
                {1, false, Vec2(0, 0.5 * kPi)}}}},
             {"base", ExactPlane{}, false, {{{0, true}}}}};
  return {"dome", s, 2.0 * kPi / 3.0};
}

/// One face.
Sample ring() {
  ExactShape s;
  s.vertices = {Vec3(4, 0, 0)};
  s.edges = {
      {"", 0, 0, circle(Vec3::Zero(), 4.0), 0, kWholeTurn},
      {"", 0, 0, ExactEllipse{Vec3(3, 0, 0), Vec3::UnitX(), Vec3::UnitZ()}, 0,
       kWholeTurn}};
  s.faces = {{"ring",
              ExactTorus{ExactFrame(), 3.0, 1.0},
              true,
              {around(0, 1, 0, kWholeTurn)}}};
  return {"ring", s, 6.0 * kPi * kPi};
}

/// A quarter of a cylinder of radius 2, its round face and arcs of splines.
Sample quarter(double height) {
  ExactShape s;
  const double w = std::sqrt(0.5);
  for (const double z : {0.0, height}) {
    s.vertices.emplace_back(0, 0, z);
    s.vertices.emplace_back(2, 0, z);
    s.vertices.emplace_back(0, 2, z);
  }
  const auto line = [&](int a, int b) {
    const Vec3 way = s.vertices[b] - s.vertices[a];
    s.edges.push_back(
        {"", a, b, ExactLine{s.vertices[a], way.normalized()}, 0, way.norm()});
  };
  for (const int at : {0, 3}) {  // edges 0, 1, 2 and 3, 4, 5
    line(at, at + 1);
    const double z = s.vertices[at].z();
    s.edges.push_back(
        {"", at + 1, at + 2,
         ExactSpline{2,
                     {0, 0, 0, 1, 1, 1},
                     {Vec3(2, 0, z), Vec3(2, 2, z), Vec3(0, 2, z)},
                     {1, w, 1}},
         0, 1});
    line(at + 2, at);
  }
  for (const int at : {0, 1, 2}) {  // edges 6, 7, 8
    line(at, at + 3);
  }
  const ExactFrame front{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ(),
                         -Vec3::UnitY()};
  const ExactFrame left{Vec3::Zero(), Vec3::UnitY(), Vec3::UnitZ(),
                        Vec3::UnitX()};
  ExactSplineSurface round{
      2, 1, {0, 0, 0, 1, 1, 1}, {0, 0, height, height}, {}, {1, 1, w, w, 1, 1}};
  for (const Vec3& p : {Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(0, 2, 0)}) {
    round.poles.push_back(p);
    round.poles.push_back(p + height * Vec3::UnitZ());
  }
  s.faces = {
      {"bottom", ExactPlane{}, false, {{{0, true}, {1, true}, {2, true}}}},
      {"top",
       ExactPlane{at_height(height)},
       true,
       {{{3, true}, {4, true}, {5, true}}}},
      {"front",
       ExactPlane{front},
       true,
       {{{0, true}, {7, true}, {3, false}, {6, false}}}},
      {"left",
       ExactPlane{left},
       false,
       {{{2, false}, {8, true}, {5, true}, {6, false}}}},
      {"round",
       round,
       true,
       {{{1, true, Vec2(0, 0)},
         {8, true, Vec2(1, 0)},
         {4, false, Vec2(1, height)},
         {7, false, Vec2(0, height)}}}}};
  return {"quarter", s, kPi * height};
}

/// Its faces but `open` as a body.
films::FilmSystem system_of(const ExactShape& shape,
                            const std::string& open = "") {
  films::FilmSystem system;
  system.solids.push_back(
      {.name = "solid", .shape = std::make_shared<const ExactShape>(shape)});
  system.bodies = {{"part", {}, {}, {}}};
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    if (shape.faces[f].name == open) {
      continue;
    }
    films::CapSpec cap{.name = "solid/" + shape.faces[f].name, .curve = ""};
    cap.solid = 0;
    cap.face = static_cast<int>(f);
    system.caps.push_back(cap);
    system.bodies[0].enclosed_by.push_back(cap.name);
  }
  return system;
}

double volume_of(const films::FilmComplex& complex) {
  return enclosed_volume(films::body_surface(complex, complex.bodies[0]));
}

/// Off the surfaces or edges that they are said to be on.
double most_off(const films::FilmComplex& complex) {
  double most = 0.0;
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    const films::ComplexVertex& vertex = complex.vertices[v];
    const Vec3 there =
        vertex.kind == films::VertexKind::OnFace
            ? point_on(complex.solid_faces[vertex.curve].face().surface,
                       {vertex.t, vertex.share})
            : point_on(complex.solid_edges[vertex.curve].edge().curve,
                       vertex.t);
    most = std::max(most, (there - complex.mesh.points[v]).norm());
  }
  return most;
}

TEST(SolidStart, ClosesWithTheVolumeOfItsFaces) {
  for (const Sample& sample : {pipe(0.5), pipe(5.0), cone(0.3), cone(2.0),
                               dome(), ring(), quarter(1.5)}) {
    for (const double edge : {2.0, 0.7, 0.35}) {
      SCOPED_TRACE(fmt::format("{} {}", sample.name, edge));
      const films::FilmComplex coarse =
          start::build_start(system_of(sample.shape), edge);
      test_films::check_complex(coarse);
      const films::FilmComplex middle = groom::refine(coarse).complex;
      const films::FilmComplex fine = groom::refine(middle).complex;
      EXPECT_LT(most_off(fine), kOnSurface * 5.0);
      const auto findings =
          check_surface(films::body_surface(fine, fine.bodies[0]));
      EXPECT_TRUE(findings.empty()) << summary(findings);
      const double richardson =
          (4.0 * volume_of(fine) - volume_of(middle)) / 3.0;
      const double size = std::min(edge, 0.5);  // twelve pieces to a turn
      EXPECT_NEAR(richardson / sample.volume, 1.0,
                  kFourth * std::pow(size / 0.35, 4));
    }
  }
}

TEST(SolidStart, ASphereFromPoleToPoleIsRefused) {
  ExactShape s = dome().shape;
  s.vertices = {Vec3(0, 0, -1), Vec3(0, 0, 1)};
  s.edges = {{"", 0, 1,
              ExactEllipse{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ()},
              -0.5 * kPi, 0.5 * kPi}};
  s.faces = {{"ball",
              ExactSphere{},
              true,
              {{{0, true, Vec2(kWholeTurn, -0.5 * kPi)},
                {0, false, Vec2(0, 0.5 * kPi)}}}}};
  try {
    start::build_start(system_of(s), 0.4);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("solid/ball"), std::string::npos)
        << error.what();
  }
}

/// Turned by p and moved by 2 p.
curves::CurveCopy moved(const curves::Curve& curve, double p) {
  return {.of = std::make_shared<const curves::Curve>(curve),
          .angle = 0.3 + p,
          .axis = Vec3(0.2, 1.0, 0.4),
          .about = Vec3(0.1, 0.0, 0.3),
          .move = Vec3(0.5, 0.0, 2.0 * p)};
}

/// A film across a dome's base bulges as the volume asks.
films::FilmSystem dome_on_a_film(double p) {
  const ExactShape shape = dome().shape;
  films::FilmSystem system = system_of(shape, "base");
  const curves::Curve rim{"rim",
                          curves::Circle{Vec3::Zero(), Vec3::UnitZ(), 1.0}};
  const curves::Curve frame{"frame", curves::Polygon{frame_points(shape)}};
  system.curves = {{"rim", moved(rim, p)}, {"frame", moved(frame, p)}};
  system.solids[0].frame = "frame";
  system.solids[0].rims = {{"rim", {0}}};
  system.caps[0].rims = {"rim"};
  system.films = {{"film", films::FilmKind::Disk, {"rim"}, 1.0, {}}};
  system.bodies[0].enclosed_by.push_back("film");
  system.bodies[0].volume = dome().volume + 0.5;
  return system;
}

films::FilmSystem rates_of_dome() {
  films::FilmSystem rates = dome_on_a_film(0.0);
  for (curves::Curve& curve : rates.curves) {
    auto& copy = std::get<curves::CurveCopy>(curve.shape);
    curves::CurveShape still = copy.of->shape;
    if (auto* polygon = std::get_if<curves::Polygon>(&still)) {
      polygon->points.assign(polygon->points.size(), Vec3::Zero());
    } else {
      still = curves::Circle{Vec3::Zero(), Vec3::Zero(), 0.0};
    }
    copy = {.of = std::make_shared<const curves::Curve>(
                curves::Curve{copy.of->name, std::move(still)}),
            .scale = Vec3::Zero(),
            .angle = 1.0,
            .axis = Vec3::Zero(),
            .move = Vec3(0.0, 0.0, 2.0)};
  }
  rates.bodies[0].volume = 0.0;
  rates.films[0].tension = 0.0;
  return rates;
}

/// Of the dome's facets off its sphere, which has moved.
double off_dome(const frozen::FilmModel& model, const Points& points,
                double p) {
  const films::FilmSystem system = dome_on_a_film(p);
  const ExactShape now = films::shape_at(system.solids[0], system.curves);
  const auto& sphere = std::get<ExactSphere>(now.faces[0].surface);
  const SurfaceMesh mesh = model.boundary(points);
  double most = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.labels[mesh.facet_label[f]] == "solid/dome") {
      for (const int corner : mesh.facets[f]) {
        const double radius =
            (mesh.points[corner] - sphere.frame.origin).norm();
        most = std::max(most, std::abs(radius - sphere.radius));
      }
    }
  }
  return most;
}

TEST(SolidStart, FilmsEndAtRims) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      dome_on_a_film(0.1), {.edge = 0.3, .refinements = 1});
  const settle::FilmState& state = model.reference();
  ASSERT_FALSE(state.failure) << state.failure->message;
  const auto findings = check_surface(model.boundary(state.points));
  EXPECT_TRUE(findings.empty()) << summary(findings);
  EXPECT_NEAR(state.report.bodies[0].volume, dome().volume + 0.5, 1e-9);
  EXPECT_LT(off_dome(model, state.points, 0.1), kOnSurface);
  const settle::FilmState moved = model.settle(dome_on_a_film(0.3));
  ASSERT_FALSE(moved.failure) << moved.failure->message;
  EXPECT_LT(off_dome(model, moved.points, 0.3), kOnSurface);
}

TEST(SolidStart, FollowsItsMotionExactly) {
  const films::FilmSystem system = dome_on_a_film(0.0);
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = 0.4, .refinements = 1});
  const settle::FilmState& state = model.reference();
  ASSERT_FALSE(state.failure) << state.failure->message;
  frozen::FilmCovector by;
  for (std::size_t v = 0; v < state.points.size(); ++v) {
    const auto angle = static_cast<double>(v);
    by.points.emplace_back(std::sin(angle), std::cos(2.0 * angle), 1.0);
  }
  const auto value = [&](double p) {
    const Points points = model.settle(dome_on_a_film(p)).points;
    double sum = 0.0;
    for (std::size_t v = 0; v < points.size(); ++v) {
      sum += by.points[v].dot(points[v]);
    }
    return sum;
  };
  const auto found = model.transpose(state, system, {by});
  const double rate = model.rate(found[0], system, rates_of_dome());
  const auto error = [&](double h) {
    return std::abs((value(h) - value(-h)) / (2.0 * h) - rate);
  };
  constexpr double kStep = 1e-2;
  EXPECT_LT(error(kStep), 1e-3 * std::abs(rate));
  // Of second order: central differences.
  EXPECT_NEAR(std::log2(error(kStep) / error(0.5 * kStep)), 2.0, 0.05);
}

}  // namespace
}  // namespace meniscus::solid_start_test
