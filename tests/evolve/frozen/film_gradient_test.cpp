// Gradients of frozen films by their design, against central differences of
// whole films.
#include <cmath>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/frozen/film_model.h"
#include "tests/support/film_systems.h"
#include "tests/support/systems.h"

namespace meniscus::film_gradient_test {
namespace {

using Design = std::function<films::FilmSystem(double)>;

/// Films are converged to rounding, so differences lose about half of their
/// figures; 6e-9 is the worst found.
constexpr double kAgree = 3e-8;
constexpr double kGradientRounding = 1e-13;

/// Weights of any kind, fixed.
double ripple(std::size_t i) { return std::sin(1.7 * static_cast<double>(i)); }

/// A response that sees everything: the mean of weighted places, and all
/// figures.
frozen::FilmCovector covector(const frozen::FilmModel& model) {
  const settle::FilmState& film = model.reference();
  frozen::FilmCovector by;
  const std::size_t count = film.points.size();
  for (std::size_t v = 0; v < count; ++v) {
    by.points.emplace_back(
        Vec3(ripple(3 * v), ripple(3 * v + 1), ripple(3 * v + 2)) /
        static_cast<double>(count));
  }
  const auto bodies = static_cast<Eigen::Index>(film.report.bodies.size());
  by.pressures = VectorX::LinSpaced(bodies, 0.3, 0.7);
  by.volumes = VectorX::LinSpaced(bodies, 0.2, 0.4);
  by.areas = model.areas(film.points);
  for (Eigen::Index s = 0; s < by.areas.size(); ++s) {
    by.areas[s] = 0.1 + 0.05 * static_cast<double>(s);
  }
  by.energy = 0.25;
  return by;
}

double value(const frozen::FilmModel& model, const frozen::FilmCovector& by,
             const settle::FilmState& film) {
  double sum = flat(by.points).dot(flat(film.points)) +
               by.areas.dot(model.areas(film.points)) +
               by.energy * film.report.energy;
  for (std::size_t b = 0; b < film.report.bodies.size(); ++b) {
    const auto at = static_cast<Eigen::Index>(b);
    sum += by.pressures[at] * film.report.bodies[b].pressure +
           by.volumes[at] * film.report.bodies[b].volume;
  }
  return sum;
}

/// Rates of a design that is linear in its variable.
void subtract(const curves::CurveShape& low, curves::CurveShape& high) {
  if (auto* c = std::get_if<curves::Circle>(&high)) {
    const auto& from = std::get<curves::Circle>(low);
    c->center -= from.center;
    c->normal -= from.normal;
    c->radius -= from.radius;
  } else if (auto* r = std::get_if<curves::Rectangle>(&high)) {
    const auto& from = std::get<curves::Rectangle>(low);
    r->center -= from.center;
    r->normal -= from.normal;
    r->axis -= from.axis;
    r->width -= from.width;
    r->height -= from.height;
    r->corner_radius -= from.corner_radius;
  }
}

void subtract(const films::FieldSpec& low, films::FieldSpec& high) {
  high.strength -= low.strength;
  high.power -= low.power;
  high.core -= low.core;
  if (auto* p = std::get_if<films::PointPole>(&high.shape)) {
    p->at -= std::get<films::PointPole>(low.shape).at;
  } else if (auto* s = std::get_if<films::SegmentPole>(&high.shape)) {
    s->from -= std::get<films::SegmentPole>(low.shape).from;
    s->to -= std::get<films::SegmentPole>(low.shape).to;
  } else if (auto* l = std::get_if<films::PolylinePole>(&high.shape)) {
    for (std::size_t k = 0; k < l->points.size(); ++k) {
      l->points[k] -= std::get<films::PolylinePole>(low.shape).points[k];
    }
  } else if (auto* q = std::get_if<films::PlanePole>(&high.shape)) {
    q->at -= std::get<films::PlanePole>(low.shape).at;
    q->normal -= std::get<films::PlanePole>(low.shape).normal;
  }
}

films::FilmSystem rates_of(const Design& design) {
  const films::FilmSystem low = design(0.0);
  films::FilmSystem rates = design(1.0);
  for (std::size_t c = 0; c < rates.curves.size(); ++c) {
    subtract(low.curves[c].shape, rates.curves[c].shape);
  }
  for (std::size_t f = 0; f < rates.films.size(); ++f) {
    rates.films[f].tension -= low.films[f].tension;
    if (rates.films[f].tension_field) {
      rates.films[f].tension_field->numbers -=
          low.films[f].tension_field->numbers;
    }
  }
  for (std::size_t f = 0; f < rates.fields.size(); ++f) {
    subtract(low.fields[f], rates.fields[f]);
  }
  for (std::size_t p = 0; p < rates.pressures.size(); ++p) {
    rates.pressures[p].pressure.numbers -= low.pressures[p].pressure.numbers;
  }
  for (std::size_t c = 0; c < rates.caps.size(); ++c) {
    if (rates.caps[c].wall) {
      rates.caps[c].wall->tension -= low.caps[c].wall->tension;
    }
  }
  for (std::size_t s = 0; s < rates.spines.size(); ++s) {
    films::SpineSpec& spine = rates.spines[s];
    spine.tension -= low.spines[s].tension;
    for (std::size_t k = 0; k < spine.points.size(); ++k) {
      spine.points[k] -= low.spines[s].points[k];
      spine.radii[k] -= low.spines[s].radii[k];
    }
  }
  for (std::size_t b = 0; b < rates.bodies.size(); ++b) {
    if (rates.bodies[b].volume) {
      *rates.bodies[b].volume -= *low.bodies[b].volume;
    }
    if (rates.bodies[b].pressure) {
      *rates.bodies[b].pressure -= *low.bodies[b].pressure;
    }
  }
  return rates;
}

/// A response, with its derivatives by the film.
using Response = std::function<frozen::FilmResponse(const settle::FilmState&,
                                                    const films::FilmSystem&)>;

/// At variable `at`, away from the frozen design. Differences of step `step`
/// and below agree, and halving it leaves a quarter of what is not linear.
void expect_exact(const frozen::FilmModel& model, const Design& design,
                  double at, double step, const Response& response) {
  ASSERT_FALSE(model.reference().failure) << model.reference().report.verdict;
  const auto film = [&](double p) {
    settle::FilmState state = model.settle(design(p));
    EXPECT_FALSE(state.failure) << state.report.verdict;
    return state;
  };
  const settle::FilmState here = film(at);
  const frozen::FilmCovector by = response(here, design(at)).by;
  const frozen::FilmGradient gradient =
      model.transpose(here, design(at), {by}).front();
  const double slope = model.rate(gradient, design(at), rates_of(design));
  const auto j = [&](double p) { return response(film(p), design(p)).value; };
  double closest = 1e300;
  for (const double s : {step, 0.1 * step, 0.01 * step}) {
    const double difference = (j(at + s) - j(at - s)) / (2.0 * s);
    closest = std::min(closest, std::abs(difference - slope));
  }
  EXPECT_LT(closest, kAgree * std::abs(slope)) << "slope " << slope;
  const double now = j(at);
  const double first = j(at + 4.0 * step) - now - 4.0 * step * slope;
  const double second = j(at + 2.0 * step) - now - 2.0 * step * slope;
  EXPECT_NEAR(std::log2(std::abs(first / second)), 2.0, 0.1);
}

void expect_exact(const frozen::FilmModel& model, const Design& design,
                  double at, double step) {
  const frozen::FilmCovector by = covector(model);
  expect_exact(
      model, design, at, step,
      [&](const settle::FilmState& film, const films::FilmSystem& /*system*/) {
        return frozen::FilmResponse{value(model, by, film), by};
      });
}

films::FilmSystem moved_rings(double p) {
  films::FilmSystem system = systems::catenoid(1.0);
  system.curves[0].shape =
      curves::Circle{Vec3(0.2 * p, 0.1 * p, -0.5 + 0.1 * p),
                     Vec3(0.15 * p, -0.1 * p, -1.0), 1.0 + 0.2 * p};
  return system;
}

TEST(FilmGradient, OfACatenoidBetweenMovingRings) {
  for (const int refinements : {0, 1}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        moved_rings(0), {.edge = 0.25, .refinements = refinements});
    expect_exact(model, moved_rings, 0.3, 1e-2);
  }
}

/// A pressed film with a bore, closed by rings whose rims leave their planes.
films::FilmSystem bored(double p) {
  films::FilmSystem system;
  system.curves = {
      {"out_low", curves::Circle{{0, 0, 0}, Vec3(0.1 * p, 0, -1), 1.0}},
      {"out_high", curves::Circle{{0, 0.1 * p, 0.8}, Vec3::UnitZ(), 1.0}},
      {"in_low", curves::Circle{{0, 0, 0.1 * p}, Vec3::UnitZ(), 0.5}},
      {"in_high",
       curves::Circle{
           {0.1 * p, 0, 0.8}, Vec3(0.2 * p, 0.1, -1.0), 0.4 + 0.1 * p}}};
  system.films = {
      {"outer", films::FilmKind::Branch, {"out_low", "out_high"}, 1.0, {}}};
  system.caps = {{"low", "out_low", "in_low"},
                 {"high", "out_high", "in_high"},
                 {"bore", "in_low", "in_high"}};
  system.bodies = {
      {"wall", {"outer", "low", "high", "bore"}, 1.9 + 0.1 * p, {}}};
  return system;
}

TEST(FilmGradient, OfRingsBetweenMovingRims) {
  for (const int refinements : {0, 1}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        bored(0), {.edge = 0.25, .refinements = refinements});
    expect_exact(model, bored, 0.3, 1e-2);
  }
}

/// A bulging tube from a ring that moves to a slanting wall that it slides on.
films::FilmSystem sliding(double p) {
  const Vec3 slope = Vec3(0.2, -0.1, 1.0);
  films::FilmSystem system;
  system.curves = {
      {"ring", curves::Circle{Vec3(0.2 * p, 0.1 * p, 0.9 + 0.1 * p),
                              Vec3(0.2 * p, 0.1, 1.0), 1.0 + 0.1 * p}},
      {"begin", curves::Circle{Vec3::Zero(), slope, 1.0}}};
  system.films = {
      {"skin", films::FilmKind::Loft, {"ring", "begin"}, 1.0 + 0.3 * p}};
  system.caps = {{"lid", "ring"}, {"foot", "begin"}};
  system.caps[1].wall =
      films::FilmWall{.normal = slope, .tension = -0.2 + 0.3 * p};
  system.bodies = {{"part", {"skin", "lid", "foot"}, 2.9 + 0.2 * p, {}}};
  return system;
}

/// A quarter of a tube between a disk and a ring around a bore, which two
/// planes cut.
films::FilmSystem quarter(double p) {
  films::FilmSystem system;
  system.curves = {
      {"low", curves::Circle{Vec3(0, 0, 0.1 * p), Vec3::UnitZ(), 1.0}},
      {"high", curves::Circle{Vec3(0, 0, 0.9), Vec3::UnitZ(), 1.0 + 0.15 * p}},
      {"in_high",
       curves::Circle{Vec3(0, 0, 0.9), Vec3::UnitZ(), 0.5 + 0.05 * p}},
      {"bottom", curves::Circle{Vec3(0, 0, 0.5), Vec3::UnitZ(), 0.4}}};
  system.films = {
      {"skin", films::FilmKind::Loft, {"low", "high"}, 1.0 + 0.3 * p, {}}};
  system.caps = {{"foot", "low"},
                 {"head", "high", "in_high"},
                 {"bore", "in_high", "bottom"},
                 {"end", "bottom"},
                 {"cut_x", ""},
                 {"cut_y", ""}};
  system.caps[4].wall = films::FilmWall{.normal = Vec3(3, 1, 0), .cuts = true};
  system.caps[5].wall = films::FilmWall{.normal = Vec3(-1, 3, 0), .cuts = true};
  system.bodies = {{"part",
                    {"skin", "foot", "head", "bore", "end", "cut_x", "cut_y"},
                    0.72 + 0.1 * p,
                    {}}};
  return system;
}

/// Two arms from a hub to rings that move, points, radii and tension of the
/// spines too; one with a tip.
films::FilmSystem spined(double p) {
  films::FilmSystem system;
  system.curves = {
      {"low", curves::Circle{{0, 0, 0}, Vec3(0.1 * p, 0, -1), 1.0}},
      {"high", curves::Circle{{2.0 + 0.2 * p, 0, 6}, Vec3(0.3, 0, 1), 0.9}}};
  system.films = {{"skin", films::FilmKind::Spines, {"low", "high"}, 1.0}};
  system.caps = {{"foot", "low"}, {"head", "high"}};
  system.bodies = {{"part", {"skin", "foot", "head"}}};
  system.spines = {
      {.name = "arm",
       .body = "part",
       .points = {{0, 0, 0}, {0.3 * p, 0.2 * p, 3.0}, {2.0 + 0.2 * p, 0, 6}},
       .radii = {1.0, 0.9 + 0.1 * p, 0.9},
       .tension = 1.0 + 0.2 * p},
      {.name = "horn",
       .body = "part",
       .points = {{0.3 * p, 0.2 * p, 3.0}, {0, 3.0 + 0.3 * p, 3.5}},
       .smooth = false,
       .radii = {0.8, 0.7 + 0.1 * p}}};
  return system;
}

TEST(FilmGradient, OfAFilmHeldBySpines) {
  for (const int refinements : {0, 1}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        spined(0), {.edge = 0.4, .refinements = refinements});
    ASSERT_FALSE(model.reference().failure)
        << model.reference().failure->message;
    expect_exact(model, spined, 0.2, 1e-2);
    expect_exact(
        model, spined, 0.2, 1e-2,
        [&](const settle::FilmState& film, const films::FilmSystem& system) {
          return model.margin(film, system);
        });
  }
}

TEST(FilmGradient, OfAQuarterThatPlanesCut) {
  for (const int refinements : {0, 1}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        quarter(0), {.edge = 0.25, .refinements = refinements});
    expect_exact(model, quarter, 0.2, 1e-2);
  }
}

TEST(FilmGradient, OfAFilmThatSlidesOnAPlane) {
  for (const int refinements : {0, 1}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        sliding(0), {.edge = 0.3, .refinements = refinements});
    expect_exact(model, sliding, 0.2, 1e-2);
    expect_exact(
        model, sliding, 0.2, 1e-2,
        [&](const settle::FilmState& film, const films::FilmSystem& system) {
          return model.margin(film, system);
        });
  }
}

/// Tubes from a ring that moves to a wall that is no plane, across its axis or
/// around it.
films::FilmSystem sliding_on(films::WallKind kind, double p) {
  films::FilmSystem system = sliding(p);
  const Vec3 slope = Vec3(0.2, -0.1, 1.0).normalized();
  films::FilmWall& wall = *system.caps[1].wall;
  wall.kind = kind;
  wall.radius = 3.0;
  wall.half_angle = 1.2;
  auto& begin = std::get<curves::Circle>(system.curves[1].shape);
  if (kind == films::WallKind::Cone) {  // down from its apex, outside
    wall.normal = -slope;
    begin.center = -slope;
    begin.radius = std::tan(wall.half_angle);
    system.bodies[0].volume = 6.5 + 0.2 * p;
  } else if (kind == films::WallKind::Sphere) {
    wall.at = -std::sqrt(8.0) * slope;
  } else {
    // Where a tube about the slope's normal meets a cylinder across it.
    wall.normal = slope.cross(Vec3::UnitX());
    const Vec3 side = wall.normal.normalized();
    const Vec3 other = slope.cross(side);
    curves::Spline saddle;
    for (int k = 0; k < 24; ++k) {
      const double t = 2.0 * 3.141592653589793 * k / 24.0;
      const double across = std::cos(t) / 3.0;
      saddle.points.push_back(std::sin(t) * side +
                              3.0 * std::sin(across) * other +
                              3.0 * (std::cos(across) - 1.0) * slope);
    }
    wall.at = -3.0 * slope;
    system.curves[1].shape = saddle;
  }
  return system;
}

TEST(FilmGradient, OfFilmsThatSlideOnBentWalls) {
  for (const films::WallKind kind :
       {films::WallKind::Sphere, films::WallKind::Cone,
        films::WallKind::Cylinder}) {
    const auto design = [kind](double p) { return sliding_on(kind, p); };
    for (const int refinements : {0, 1}) {
      const frozen::FilmModel model = frozen::FilmModel::freeze(
          design(0), {.edge = 0.45, .refinements = refinements});
      ASSERT_FALSE(model.reference().failure)
          << model.reference().failure->message;
      expect_exact(model, design, 0.2, 4e-3);
      expect_exact(
          model, design, 0.2, 4e-3,
          [&](const settle::FilmState& film, const films::FilmSystem& system) {
            return model.margin(film, system);
          });
    }
  }
}

// The other way through the same system.
TEST(FilmGradient, ForwardsOfAFilmThatSlidesIsItsTranspose) {
  for (const films::WallKind kind :
       {films::WallKind::Plane, films::WallKind::Sphere, films::WallKind::Cone,
        films::WallKind::Cylinder}) {
    const auto design = [kind](double p) {
      return kind == films::WallKind::Plane ? sliding(p) : sliding_on(kind, p);
    };
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(design(0), {.edge = 0.3, .refinements = 1});
    const films::FilmSystem system = design(0.2);
    const settle::FilmState film = model.settle(system);
    ASSERT_FALSE(film.failure);
    const films::FilmSystem rates = rates_of(design);
    frozen::FilmCovector by;
    by.points = covector(model).points;
    const double backwards =
        model.rate(model.transpose(film, system, {by}).front(), system, rates);
    const double forwards = flat(by.points).dot(
        flat(model.tangents(film, system, {rates}).front()));
    EXPECT_NEAR(forwards / backwards, 1.0, 1e-11);
  }
}

TEST(FilmGradient, ForwardsOfAFilmHeldBySpinesIsItsTranspose) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(spined(0), {.edge = 0.4, .refinements = 1});
  const films::FilmSystem system = spined(0.2);
  const settle::FilmState film = model.settle(system);
  ASSERT_FALSE(film.failure);
  const films::FilmSystem rates = rates_of(spined);
  frozen::FilmCovector by;
  by.points = covector(model).points;
  const double backwards =
      model.rate(model.transpose(film, system, {by}).front(), system, rates);
  const double forwards =
      flat(by.points).dot(flat(model.tangents(film, system, {rates}).front()));
  EXPECT_NEAR(forwards / backwards, 1.0, 1e-11);
}

films::FilmSystem blown(double p) {
  films::FilmSystem system = systems::cylinder(1.5);
  system.curves[1].shape =
      curves::Circle{Vec3(0.2 * p, 0, 1.5 + 0.1 * p),
                     Vec3(0.1 * p, 0.1 * p, 1.0), 1.0 - 0.1 * p};
  system.films[0].tension = 1.0 + 0.3 * p;
  system.bodies[0].pressure = 0.8 + 0.4 * p;
  return system;
}

TEST(FilmGradient, AtAGivenPressure) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(blown(0), {.edge = 0.3});
  expect_exact(model, blown, 0.2, 1e-2);
}

// Lengths of 100: the same weights, in mm.
films::FilmSystem bracket(double p) {
  return systems::two_arm(20.0 * p, 1.7e6 + 1e5 * p, 120.0, 50.0 - 2.0 * p);
}

TEST(FilmGradient, OfTheBracketAtAGivenVolume) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(bracket(0), {.edge = 16.0});
  expect_exact(model, bracket, 0.4, 1e-2);
}

films::FilmSystem strut(double p) {
  films::FilmSystem system = systems::strut();
  auto& square = std::get<curves::Rectangle>(system.curves[0].shape);
  square.width = 2.0 + 0.2 * p;
  square.corner_radius = 0.3 + 0.1 * p;
  square.axis = Vec3(1.0, 0.3 * p, 0.0);
  system.bodies[0].volume = 14.0 + 0.5 * p;
  return system;
}

TEST(FilmGradient, OfAStrutOnARoundedRectangle) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(strut(0), {.edge = 0.4});
  expect_exact(model, strut, 0.3, 1e-2);
}

films::FilmSystem chambers(double p) {
  films::FilmSystem system = systems::bulkhead();
  std::get<curves::Circle>(system.curves[1].shape).center =
      Vec3(0.1 * p, 0, 0.2 * p);
  std::get<curves::Circle>(system.curves[1].shape).radius = 1.2 + 0.1 * p;
  system.films[1].tension = 1.0 + 0.2 * p;
  system.films[2].tension = 1.0 - 0.1 * p;
  system.bodies[0].volume = 7.0 + 0.4 * p;
  return system;
}

TEST(FilmGradient, OfTwoChambersWithABulkhead) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(chambers(0), {.edge = 0.4});
  expect_exact(model, chambers, 0.3, 1e-2);
  // One of them a void at a pressure of its own.
  const Design vented = [](double p) {
    films::FilmSystem system = chambers(p);
    system.bodies[1].volume.reset();
    system.bodies[1].pressure = 0.9 + 0.1 * p;
    system.bodies[1].is_void = true;
    return system;
  };
  const frozen::FilmModel with_void =
      frozen::FilmModel::freeze(vented(0), {.edge = 0.4});
  expect_exact(with_void, vented, 0.3, 1e-2);
}

Expression over(const char* text) {
  return Expression::parse(text, {"x", "y", "z"});
}

films::FilmSystem in_fields(double p) {
  films::FilmSystem system = systems::cylinder(1.0);
  system.curves[1].shape = curves::Circle{Vec3(0.1 * p, 0, 1.0 + 0.2 * p),
                                          Vec3::UnitZ(), 1.0 - 0.1 * p};
  system.films[0].tension_field = over("1+0.2*z+0.1*sin(x)");
  system.bodies[0].pressure = 0.4 + 0.2 * p;
  system.fields = {{"middle", films::PlanePole{Vec3(0, 0, 0.5), Vec3::UnitZ()},
                    0.2, 2.0, 0.4, films::PerArea{{"film"}}},
                   {"inside", films::PointPole{Vec3(0.2, 0, 0.4)}, 0.1, 2.0,
                    0.5, films::PerVolume{"body"}}};
  system.pressures = {{"gas", "body", over("0.2*z")}};
  return system;
}

TEST(FilmGradient, InTensionAndEnergyFields) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(in_fields(0), {.edge = 0.6, .refinements = 0});
  expect_exact(model, in_fields, 0.3, 1e-2);
}

VectorX waving(Eigen::Index count, double size, double phase) {
  VectorX result(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    result[k] = 1.0 + size * std::sin(phase + 1.7 * static_cast<double>(k));
  }
  return result;
}

/// Fields that all follow the design.
films::FilmSystem in_smooth_fields(double p) {
  static const auto kBox =
      box_splines({.from = {-1, -1, 0}, .to = {1, 1, 1}, .counts = {3, 4, 3}});
  static const auto kAxis =
      axis_splines({.from = {0, 0.1, 0}, .along = 3, .around = 4});
  films::FilmSystem system = in_fields(p);
  PlaceField tension = Expression::parse("a*skin*(1+0.1*sin(x+b))",
                                         {"x", "y", "z", "a", "b", "skin"});
  tension.names = {"a", "b"};
  tension.shapes = {kBox};
  tension.numbers = waving(2 + kBox->coefficients(), 0.1, 0.4) +
                    p * waving(2 + kBox->coefficients(), 0.1, 1.3) * 0.2;
  system.films[0].tension_field = tension;
  PlaceField gas =
      Expression::parse("c*z+0.1*ring", {"x", "y", "z", "c", "ring"});
  gas.names = {"c"};
  gas.shapes = {kAxis};
  gas.numbers = waving(1 + kAxis->coefficients(), 0.3, 0.0) +
                p * waving(1 + kAxis->coefficients(), 0.3, 0.7) * 0.3;
  system.pressures = {{"gas", "body", gas}};
  system.fields = {
      {"plane",
       films::PlanePole{Vec3(0, 0, 0.5 + 0.2 * p), Vec3(0.2 * p, 0, 1)},
       0.2 + 0.1 * p, 2.0 + 0.5 * p, 0.4, films::PerArea{{"film"}}, true, true},
      {"point", films::PointPole{Vec3(0.2, 0.3 * p, 0.4)}, 0.1, 2.0,
       0.5 + 0.1 * p, films::PerVolume{"body"}, true, true},
      {"still", films::PointPole{Vec3(0, 0.2, 0.3)}, 0.05, 2.0, 0.7,
       films::PerArea{{"film"}}}};
  return system;
}

/// And poles whose second derivatives jump, which no margin likes.
films::FilmSystem in_moving_fields(double p) {
  films::FilmSystem system = in_smooth_fields(p);
  const films::FieldSpec still = system.fields.back();
  system.fields.pop_back();
  const films::FieldSpec more[] = {
      {"segment",
       films::SegmentPole{Vec3(-0.4, 0.1 * p, 0.4),
                          Vec3(0.3 + p * 0.2, 0, 0.7)},
       0.1 - 0.3 * p, 3.0, 0.6, films::PerArea{{"film"}}, true, true},
      {"path",
       films::PolylinePole{
           {Vec3(3, 0, 0), Vec3(3, 1, 0.2 * p), Vec3(4 + p, 2, 1)}},
       0.2, 3.0 - 0.2 * p, 0.6, films::PerArea{{"film"}}, true, true}};
  system.fields.insert(system.fields.end(), std::begin(more), std::end(more));
  system.fields.push_back(still);
  return system;
}

TEST(FilmGradient, InFieldsThatFollowTheDesign) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      in_moving_fields(0), {.edge = 0.9, .refinements = 0});
  expect_exact(model, in_moving_fields, 0.3, 1e-2);
}

TEST(FilmMargin, HasAnExactGradientInFieldsThatFollowTheDesign) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      in_smooth_fields(0), {.edge = 1.0, .refinements = 0});
  expect_exact(
      model, in_smooth_fields, 0.2, 4e-3,
      [&model](const settle::FilmState& film, const films::FilmSystem& system) {
        return model.margin(film, system);
      });
}

TEST(FilmGradient, InMovingFieldsIsTheTangentTransposed) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      in_moving_fields(0), {.edge = 0.9, .refinements = 0});
  const films::FilmSystem system = in_moving_fields(0.2);
  const settle::FilmState film = model.settle(system);
  frozen::FilmCovector by;
  by.points = covector(model).points;
  const films::FilmSystem rates = rates_of(in_moving_fields);
  const double backward =
      model.rate(model.transpose(film, system, {by}).front(), system, rates);
  EXPECT_NEAR(
      flat(by.points).dot(flat(model.tangents(film, system, {rates}).front())),
      backward, 1e-11 * std::abs(backward));
}

// Another design of a model's fields is the film that another model of that
// design has.
TEST(FilmModel, FollowsItsFields) {
  const frozen::FilmModelOptions options{.edge = 0.4, .refinements = 0};
  const films::FilmSystem there = in_moving_fields(0.2);
  const settle::FilmState moved =
      frozen::FilmModel::freeze(in_moving_fields(0), options).settle(there);
  const settle::FilmState own =
      frozen::FilmModel::freeze(there, options).settle(there);
  ASSERT_FALSE(moved.failure) << moved.report.verdict;
  ASSERT_FALSE(own.failure) << own.report.verdict;
  // Other facets of the same film: of second order in their edges.
  EXPECT_NEAR(moved.report.energy, own.report.energy,
              4e-3 * std::abs(own.report.energy));
  films::FilmSystem other = there;
  other.fields.pop_back();
  EXPECT_THROW(frozen::FilmModel::freeze(there, options).settle(other),
               InvalidInput);
}

// A deep pole moves far from where its model was frozen: rays to it go along.
TEST(FilmModel, FollowsAPoleThatGoesFar) {
  const auto design = [](double p) {
    films::FilmSystem system = systems::cylinder(1.0);
    system.bodies[0].volume.reset();
    system.bodies[0].pressure = 1.0;
    system.fields = {{"pull", films::PointPole{Vec3(0.5 * p, 0, 0.5)}, 0.3, 2.0,
                      0.1, films::PerVolume{"body"}, true, true}};
    return system;
  };
  const frozen::FilmModelOptions options{.edge = 0.3, .refinements = 0};
  const settle::FilmState moved =
      frozen::FilmModel::freeze(design(0), options).settle(design(1));
  const settle::FilmState own =
      frozen::FilmModel::freeze(design(1), options).settle(design(1));
  ASSERT_FALSE(moved.failure) << moved.report.verdict;
  ASSERT_FALSE(own.failure) << own.report.verdict;
  EXPECT_NEAR(moved.report.energy, own.report.energy,
              2e-3 * std::abs(own.report.energy));
}

// Young and Laplace without a mesh: the energy at rest grows with the volume
// by the pressure, with a tension by the area.
TEST(FilmGradient, OfTheEnergyIsPressureAndArea) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(chambers(0), {.edge = 0.4});
  const films::FilmSystem system = chambers(0.3);
  const settle::FilmState film = model.settle(system);
  frozen::FilmCovector energy;
  energy.energy = 1.0;
  const frozen::FilmGradient gradient =
      model.transpose(film, system, {energy}).front();
  const VectorX areas = model.areas(film.points);
  // Of a film at rest; its residual is below 1e-9.
  constexpr double kAtRest = 1e-9;
  for (const int b : {0, 1}) {
    EXPECT_NEAR(gradient.volumes[b], film.report.bodies[b].pressure, kAtRest);
    EXPECT_EQ(gradient.pressures[b], 0.0);
  }
  EXPECT_LT((gradient.tensions - areas).cwiseAbs().maxCoeff(),
            kAtRest * areas.maxCoeff());
}

TEST(FilmMargin, BoundsTheLowestEigenvalueFromBelow) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(bracket(0), {.edge = 16.0});
  const settle::FilmState film = model.settle(bracket(0.4));
  const double least = film.report.min_eigenvalue;
  double before = -1e300;
  for (const double sharpness : {5.0, 20.0, 1000.0}) {
    const double margin =
        model.margin(film, bracket(0.4), {.sharpness = sharpness}).value;
    EXPECT_GT(margin, before);
    // The report's eigenvalue is good to 1e-6 (Lanczos).
    EXPECT_LT(margin, (1.0 + 1e-5) * least);
    before = margin;
  }
  EXPECT_GT(before, 0.99 * least);
  EXPECT_THROW(
      static_cast<void>(model.margin(film, bracket(0.4), {.sharpness = 0.0})),
      InvalidInput);
  EXPECT_THROW(
      static_cast<void>(model.margin(film, bracket(0.4), {.modes = 0})),
      InvalidInput);
}

TEST(FilmMargin, HasAnExactGradient) {
  const auto margin = [](const frozen::FilmModel& model) -> Response {
    return [&model](const settle::FilmState& film,
                    const films::FilmSystem& system) {
      return model.margin(film, system);
    };
  };
  const frozen::FilmModel arms =
      frozen::FilmModel::freeze(bracket(0), {.edge = 16.0});
  expect_exact(arms, bracket, 0.4, 4e-3, margin(arms));
  const frozen::FilmModel tube =
      frozen::FilmModel::freeze(blown(0), {.edge = 0.3});
  expect_exact(tube, blown, 0.2, 4e-3, margin(tube));
  const frozen::FilmModel twin =
      frozen::FilmModel::freeze(chambers(0), {.edge = 0.4});
  expect_exact(twin, chambers, 0.3, 4e-3, margin(twin));
}

// The catenoid's waist c = 0.848338 has k = 1 / c both ways.
TEST(FilmRadius, OfACatenoidIsThatOfItsWaist) {
  constexpr double kWaist = 0.848338;
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(systems::catenoid(1.0), {.edge = 0.1});
  const Points& film = model.reference().points;
  // Both curvatures count, over a waist that is a part of the film.
  EXPECT_NEAR(model.smallest_radius(film, 64).value, kWaist, 0.02 * kWaist);
  EXPECT_NEAR(model.smallest_radius(film).value, kWaist, 0.06 * kWaist);
  EXPECT_THROW(static_cast<void>(model.smallest_radius(film, 7)), InvalidInput);
}

TEST(FilmRadius, HasAnExactGradient) {
  const auto radius = [](const frozen::FilmModel& model) -> Response {
    return [&model](const settle::FilmState& film,
                    const films::FilmSystem& /*system*/) {
      return model.smallest_radius(film.points);
    };
  };
  const frozen::FilmModel arms =
      frozen::FilmModel::freeze(bracket(0), {.edge = 16.0});
  expect_exact(arms, bracket, 0.4, 1e-2, radius(arms));
  const frozen::FilmModel rings =
      frozen::FilmModel::freeze(moved_rings(0), {.edge = 0.25});
  expect_exact(rings, moved_rings, 0.3, 1e-2, radius(rings));
}

TEST(FilmGradient, HasTheSameBitsInAnyCompany) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(bracket(0), {.edge = 16.0});
  const films::FilmSystem system = bracket(0.4);
  const settle::FilmState film = model.settle(system);
  const frozen::FilmCovector by = covector(model);
  frozen::FilmCovector energy;
  energy.energy = 1.0;
  const auto alone = model.transpose(film, system, {by});
  std::vector<frozen::FilmGradient> others;
  std::vector<frozen::FilmGradient> again;
  std::thread a([&] { others = model.transpose(film, system, {energy}); });
  std::thread b([&] { again = model.transpose(film, system, {energy, by}); });
  a.join();
  b.join();
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_TRUE(alone[0].rims[c].by_points == again[1].rims[c].by_points);
    EXPECT_TRUE(others[0].rims[c].by_points == again[0].rims[c].by_points);
  }
  EXPECT_TRUE(alone[0].volumes == again[1].volumes);
}

TEST(FilmGradient, OfTheMeshedSurfaceIsItsTranspose) {
  frozen::FilmModel model =
      frozen::FilmModel::freeze(bracket(0), {.edge = 16.0, .refinements = 2});
  for (const bool split : {false, true}) {
    if (split) {
      std::vector<char> marked(
          model.surface(model.reference().points).base.facets.size(), 0);
      marked[5] = 1;
      model.split_facets(marked);
    }
    const Points& x = model.reference().points;
    const QuadraticSurface surface = model.surface(x);
    Points corners = surface.base.points;
    Points mid = surface.mid;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      corners[i].setConstant(ripple(i));
    }
    for (std::size_t i = 0; i < mid.size(); ++i) {
      mid[i].setConstant(ripple(7 * i));
    }
    const double there = flat(corners).dot(flat(surface.base.points)) +
                         flat(mid).dot(flat(surface.mid));
    const double back =
        flat(x).dot(flat(model.transpose_surface(corners, mid)));
    EXPECT_NEAR(back, there, kGradientRounding * flat(x).cwiseAbs().sum());
  }
}

TEST(FilmGradient, RefusesWhatDoesNotFit) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(moved_rings(0), {.edge = 0.25});
  const settle::FilmState film = model.settle(moved_rings(0.1));
  frozen::FilmCovector by;
  EXPECT_NO_THROW(model.transpose(film, moved_rings(0.1), {by}));
  EXPECT_THROW(model.transpose(film, moved_rings(0.2), {by}), InvalidInput);
  by.points.resize(3, Vec3::Zero());
  EXPECT_THROW(model.transpose(film, moved_rings(0.1), {by}), InvalidInput);
  by.points.clear();
  by.volumes = VectorX::Ones(1);
  EXPECT_THROW(model.transpose(film, moved_rings(0.1), {by}), InvalidInput);
  by.volumes.resize(0);
  settle::FilmState failed = film;
  failed.failure = Failure{FailureKind::FilmNotFound, "gone"};
  EXPECT_THROW(model.transpose(failed, moved_rings(0.1), {by}), InvalidInput);
  const frozen::FilmGradient gradient =
      model.transpose(film, moved_rings(0.1), {by}).front();
  films::FilmSystem rates = moved_rings(0.1);
  rates.curves[0].shape = curves::Rectangle{};
  EXPECT_THROW(static_cast<void>(model.rate(gradient, moved_rings(0.1), rates)),
               InvalidInput);
}

}  // namespace
}  // namespace meniscus::film_gradient_test
