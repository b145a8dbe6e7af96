// Films between curves that planes of symmetry cut: halves and quarters are
// the whole's.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "evolve/curves/curve_cut.h"
#include "evolve/films/body_sides.h"
#include "evolve/frozen/film_model.h"
#include "evolve/start/start_complex.h"

namespace meniscus::cut_films_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kSame = 1e-9;    // a half's film and the whole's
constexpr double kTables = 2e-8;  // of lengths, the same
constexpr double kFlat = 1e-12;

/// Closes the system's only body by the planes through the origin across the
/// first `planes` axes; the body's volume is that of the whole.
void cut(films::FilmSystem& system, int planes) {
  for (int p = 0; p < planes; ++p) {
    films::CapSpec face;
    face.name = "cut_" + std::to_string(p);
    face.wall = films::FilmWall{.normal = 2.0 * Vec3::Unit(p), .cuts = true};
    system.caps.push_back(face);
    system.bodies[0].enclosed_by.push_back(face.name);
    *system.bodies[0].volume /= 2.0;
  }
}

films::FilmSystem tube(double volume) {
  films::FilmSystem system;
  system.curves = {
      {"low", curves::Circle{Vec3(0, 0, -0.5), Vec3::UnitZ(), 1.0}},
      {"high", curves::Circle{Vec3(0, 0, 0.5), Vec3::UnitZ(), 0.9}}};
  system.films = {{"skin", films::FilmKind::Loft, {"low", "high"}, 1.0, {}}};
  system.caps = {{"foot", "low"}, {"head", "high"}};
  system.bodies = {{"part", {"skin", "foot", "head"}, volume, {}}};
  return system;
}

/// A pressed film with a bore, closed by rings, of which one may end at an
/// ellipse: partners on unlike curves follow from tables of their lengths.
films::FilmSystem bored(double wide) {
  films::FilmSystem system;
  system.curves = {
      {"out_low", curves::Circle{Vec3::Zero(), -Vec3::UnitZ(), 1.0}},
      {"out_high", curves::Circle{{0, 0, 0.8}, Vec3::UnitZ(), 1.0}},
      {"in_low", curves::Circle{Vec3::Zero(), Vec3::UnitZ(), 0.5}},
      {"in_high", curves::Circle{{0, 0, 0.8}, -Vec3::UnitZ(), 0.4}}};
  if (wide > 0.4) {
    system.curves[3].shape =
        curves::Ellipse{{0, 0, 0.8}, -Vec3::UnitZ(), Vec3::UnitY(), 0.4, wide};
  }
  system.films = {
      {"outer", films::FilmKind::Branch, {"out_low", "out_high"}, 1.0, {}}};
  system.caps = {{"low", "out_low", "in_low"},
                 {"high", "out_high", "in_high"},
                 {"bore", "in_low", "in_high"}};
  system.bodies = {{"wall", {"outer", "low", "high", "bore"}, 1.9, {}}};
  return system;
}

double wrapped(double t) {
  return t - std::floor(t) < 1.0 ? t - std::floor(t) : 0.0;
}

/// Doubled by the plane across axis `p`, on curves that are their own images.
films::FilmComplex with_image(const films::FilmComplex& half, int p) {
  films::FilmComplex whole = half;
  whole.edges.clear();
  std::vector<int> image(half.vertices.size());
  for (std::size_t v = 0; v < image.size(); ++v) {
    const Vec3& at = half.mesh.points[v];
    films::ComplexVertex vertex = half.vertices[v];
    image[v] = static_cast<int>(v);
    if (std::abs(at[p]) < kFlat) {
      continue;
    }
    if (vertex.kind == films::VertexKind::OnCurve) {
      const std::vector<double> t = curves::crossings(
          half.curves[vertex.curve].shape, Vec3::Zero(), Vec3::Unit(p));
      vertex.t = wrapped(2.0 * t[0] - vertex.t);
    } else if (vertex.kind == films::VertexKind::OnBand) {
      const std::vector<double> t =
          curves::crossings(half.curves[half.bands[vertex.curve].outer].shape,
                            Vec3::Zero(), Vec3::Unit(p));
      vertex.t = wrapped(2.0 * t[0] - vertex.t);
    }
    image[v] = static_cast<int>(whole.vertices.size());
    whole.vertices.push_back(vertex);
    Vec3 there = at;
    there[p] = -at[p];
    whole.mesh.points.push_back(there);
  }
  for (std::size_t f = 0; f < half.mesh.facets.size(); ++f) {
    const auto [a, b, c] = half.mesh.facets[f];
    whole.mesh.facets.push_back({image[b], image[a], image[c]});
    whole.mesh.facet_label.push_back(half.mesh.facet_label[f]);
  }
  return whole;
}

/// The whole's complex with the facets of its part and of their images.
films::FilmComplex mirrored(const frozen::FilmModel& part,
                            const films::FilmSystem& part_system,
                            const films::FilmSystem& whole_system, int planes) {
  const films::FilmComplex images =
      part.meshed_at(part.reference(), part_system);
  SurfaceMesh kept = images.mesh;
  kept.facets.clear();
  kept.facet_label.clear();
  films::FilmComplex whole = start::build_start(whole_system, 0.25);
  whole.bands = images.bands;  // partners exactly where the planes cut
  for (std::size_t f = 0; f < images.mesh.facets.size(); ++f) {
    const int label = images.mesh.facet_label[f];
    if (!images.surfaces[label].wetted) {
      kept.facets.push_back(images.mesh.facets[f]);
      kept.facet_label.push_back(
          whole.mesh.label_of(images.surfaces[label].name));
    }
  }
  std::vector<int> number(kept.points.size(), -1);
  for (const Triangle& t : kept.facets) {
    for (const int v : t) {
      number[v] = 0;
    }
  }
  whole.mesh.points.clear();
  whole.vertices.clear();
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) {
      number[v] = static_cast<int>(whole.vertices.size());
      whole.vertices.push_back(images.vertices[v]);
      whole.vertices.back().constraints = -1;
      whole.mesh.points.push_back(kept.points[v]);
    }
  }
  for (Triangle& t : kept.facets) {
    t = {number[t[0]], number[t[1]], number[t[2]]};
  }
  whole.mesh.facets = kept.facets;
  whole.mesh.facet_label = kept.facet_label;
  whole.edges.clear();
  for (int p = 0; p < planes; ++p) {
    whole = with_image(whole, p);
  }
  return whole;
}

struct Figures {
  double pressure = 0.0;
  double area = 0.0;
};

Figures figures(const frozen::FilmModel& model) {
  const settle::FilmState& film = model.reference();
  return {film.report.bodies[0].pressure, model.areas(film.points)[0]};
}

void expect_part_of_the_whole(const films::FilmSystem& system, int planes,
                              double same = kSame) {
  films::FilmSystem part_system = system;
  cut(part_system, planes);
  const double parts = std::pow(2.0, planes);
  const frozen::FilmModel part =
      frozen::FilmModel::freeze(part_system, {.edge = 0.25, .refinements = 0});
  ASSERT_FALSE(part.reference().failure) << part.reference().failure->message;
  const SurfaceMesh closed = part.boundary(part.reference().points);
  EXPECT_THAT(check_surface(closed), IsEmpty());
  EXPECT_NEAR(enclosed_volume(closed) * parts, *system.bodies[0].volume, kSame);
  const films::FilmComplex start = mirrored(part, part_system, system, planes);
  const frozen::FilmModel whole = frozen::FilmModel::freeze(
      system,
      {.edge = 0.25, .refinements = 0, .start = &start, .at_rest = true});
  ASSERT_FALSE(whole.reference().failure) << whole.reference().failure->message;
  ASSERT_EQ(whole.reference().points.size(), start.mesh.points.size());
  double off = 0.0;
  for (std::size_t v = 0; v < start.mesh.points.size(); ++v) {
    off = std::max(off,
                   (whole.reference().points[v] - start.mesh.points[v]).norm());
  }
  EXPECT_LT(off, same);
  EXPECT_NEAR(figures(part).pressure, figures(whole).pressure, same);
  EXPECT_NEAR(figures(part).area * parts / figures(whole).area, 1.0, same);
}

TEST(CutFilms, HalvesAndQuartersOfTubesAreTheWholes) {
  for (const int planes : {1, 2}) {
    for (const double volume : {2.2, 2.85, 4.0}) {  // neck, cone, belly
      SCOPED_TRACE(testing::Message() << planes << " planes, " << volume);
      expect_part_of_the_whole(tube(volume), planes);
    }
  }
}

TEST(CutFilms, SoAreThoseWithRingsAndBores) {
  for (const int planes : {1, 2}) {
    SCOPED_TRACE(planes);
    expect_part_of_the_whole(bored(0.4), planes);
    expect_part_of_the_whole(bored(0.5), planes, kTables);
  }
}

/// On other facets than the whole's.
struct Settled {
  VectorX pressures;
  double area = 0.0;
  double volume = 0.0;
};

Settled settled(const films::FilmSystem& system) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = 0.2, .refinements = 1});
  EXPECT_FALSE(model.reference().failure) << model.reference().failure->message;
  const settle::FilmState& film = model.reference();
  const SurfaceMesh closed = model.boundary(film.points);
  EXPECT_THAT(check_surface(closed), IsEmpty());
  Settled result{VectorX(std::ssize(film.report.bodies)), 0.0,
                 enclosed_volume(closed)};
  for (Eigen::Index b = 0; b < result.pressures.size(); ++b) {
    result.pressures[b] =
        film.report.bodies[static_cast<std::size_t>(b)].pressure;
  }
  result.area = model.areas(film.points)[0];
  return result;
}

TEST(CutFilms, AnEighthSlidesOnAThirdPlane) {
  constexpr double kFacets = 4e-3;  // edges of 0.2 on a radius of 1
  films::FilmSystem half = tube(4.0);
  half.curves[1] = {"high", curves::Circle{Vec3::Zero(), Vec3::UnitZ(), 1.0}};
  half.caps[1].wall = films::FilmWall{};
  half.bodies[0].volume = 1.8;
  films::FilmSystem eighth = half;
  cut(eighth, 2);
  const Settled whole = settled(half);
  const Settled part = settled(eighth);
  EXPECT_NEAR(4.0 * part.volume, whole.volume, kSame);
  EXPECT_NEAR(4.0 * part.area / whole.area, 1.0, kFacets);
  EXPECT_NEAR(part.pressures[0] / whole.pressures[0], 1.0, kFacets);
}

TEST(CutFilms, BodiesMayShareAFilmThatIsCut) {
  constexpr double kFacets = 2e-2;
  const Vec3 at(1, 2, 7);
  films::FilmSystem system;
  system.curves = {
      {"low", curves::Circle{Vec3(1, 2, -0.5), Vec3::UnitZ(), 1.0}},
      {"middle", curves::Circle{Vec3(1, 2, 0), Vec3::UnitZ(), 1.0}},
      {"high", curves::Circle{Vec3(1, 2, 0.5), Vec3::UnitZ(), 1.0}}};
  system.films = {{"a", films::FilmKind::Loft, {"low", "middle"}, 1.0, {}},
                  {"b", films::FilmKind::Loft, {"middle", "high"}, 1.0, {}},
                  {"between", films::FilmKind::Disk, {"middle"}, 0.5, {}}};
  system.caps = {{"foot", "low"}, {"head", "high"}};
  system.bodies = {{"p", {"a", "foot", "between"}, 1.9, {}},
                   {"q", {"b", "head", "between"}, 1.6, {}}};
  films::FilmSystem half = system;
  for (films::BodySpec& body : half.bodies) {
    films::CapSpec face;
    face.name = body.name + "_cut";
    face.wall =
        films::FilmWall{.at = at, .normal = Vec3(1, -1, 0), .cuts = true};
    half.caps.push_back(face);
    body.enclosed_by.push_back(face.name);
    *body.volume /= 2.0;
  }
  const Settled whole = settled(system);
  const Settled part = settled(half);
  EXPECT_NEAR(2.0 * part.volume, whole.volume, kSame);
  EXPECT_NEAR(2.0 * part.area / whole.area, 1.0, kFacets);
  for (Eigen::Index b = 0; b < 2; ++b) {
    EXPECT_NEAR(part.pressures[b] / whole.pressures[b], 1.0, kFacets);
  }
}

// Off by what a text's digits leave, less than an image may be.
TEST(CutFilms, CornersNextToAPlaneAreWhereItPasses) {
  constexpr double kOff = 9e-10;
  const curves::Polygon square{
      {{-kOff, -1, 0}, {1, 0, 0}, {kOff, 1, 0}, {-1, 0, 0}}};
  const std::vector<double> at =
      curves::crossings(square, Vec3::Zero(), Vec3::UnitX());
  EXPECT_THAT(at, ElementsAre(0.0, 0.5));
  const std::vector<double> samples = curves::sample_parameters(square, 0.1);
  EXPECT_EQ(curves::with_parameters(square, samples, at), samples);
}

// However near to each other.
TEST(CutFilms, AllPlacesThatAreWantedAreThere) {
  const curves::Circle circle{Vec3::Zero(), Vec3::UnitZ(), 1.0};
  const std::vector<double> wanted = {0.31, 0.312, 0.315, 0.999, 0.9995};
  const std::vector<double> samples = curves::with_parameters(
      circle, curves::sample_parameters(circle, 1.0), wanted);
  EXPECT_TRUE(std::is_sorted(samples.begin(), samples.end()));
  for (const double t : wanted) {
    EXPECT_EQ(std::count(samples.begin(), samples.end(), t), 1) << t;
  }
}

/// The first film's highest point.
double height_of(const films::FilmSystem& system) {
  const films::FilmComplex start = start::build_start(system, 0.2);
  double most = 0.0;
  for (std::size_t f = 0; f < start.mesh.facets.size(); ++f) {
    for (const int v : start.mesh.facets[f]) {
      most = start.mesh.facet_label[f] == 0
                 ? std::max(most, start.mesh.points[v].z())
                 : most;
    }
  }
  return most;
}

TEST(CutFilms, DisksBeginAsHighAsThoseOfTheWhole) {
  films::FilmSystem whole;
  whole.curves = {{"rim", curves::Circle{}}};
  whole.films = {{"drop", films::FilmKind::Disk, {"rim"}, 1.0, {}}};
  whole.caps = {{"foot", "rim"}};
  whole.bodies = {{"part", {"drop", "foot"}, 1.2, {}}};
  for (const int planes : {1, 2}) {
    films::FilmSystem part = whole;
    cut(part, planes);
    EXPECT_NEAR(height_of(part) / height_of(whole), 1.0, 0.05) << planes;
  }
}

// An elbow from one plane to another, its foot across two others with a window
// beside their corner: the third one lies along the foot.
TEST(CutFilms, AFaceIsClosedByThePlanesThatMeetIt) {
  constexpr double kChords = 0.03;
  films::FilmSystem system;
  system.curves = {
      {"low", curves::Circle{Vec3(0, 0, -1.5), -Vec3::UnitZ(), 0.5}},
      {"west", curves::Circle{Vec3(-1.5, 0, 0), -Vec3::UnitX(), 0.5}},
      {"hole", curves::Circle{Vec3(-0.25, 0, -1.5), -Vec3::UnitZ(), 0.12}}};
  system.films = {{"skin", films::FilmKind::Branch, {"low", "west"}, 1.0, {}},
                  {"window", films::FilmKind::Disk, {"hole"}, 1.0, {}}};
  system.caps = {{"foot", "low"}, {"side", "west"}};
  system.caps[0].more = {"hole"};
  system.bodies = {{"part", {"skin", "window", "foot", "side"}, 1.0, {}}};
  cut(system, 3);
  const films::FilmComplex start = start::build_start(system, 0.1);
  for (const Finding& finding :
       check_surface(films::body_surface(start, start.bodies[0]))) {
    EXPECT_EQ(finding.kind, FindingKind::Degenerate);  // of the hull's facets
  }
  const double area = std::numbers::pi * (0.25 / 4.0 - 0.0144 / 2.0);
  EXPECT_NEAR(surface_area(start.mesh, start.mesh.label_of("foot")) / area, 1.0,
              kChords);
}

// A film beside the tube ends at a solid in the plane, which holds it.
TEST(CutFilms, SolidsInThePlaneStay) {
  constexpr double kChords = 0.02;
  films::FilmSystem system = tube(4.0);
  const curves::Circle near{Vec3(0, 0, -4), Vec3::UnitX(), 0.5};
  const curves::Circle far{Vec3(-2, 0, -4), -Vec3::UnitX(), 0.5};
  system.curves.push_back({"near", near});
  system.curves.push_back({"far", far});
  system.films.push_back({"arm", films::FilmKind::Loft, {"near", "far"}});
  system.caps.push_back({"pad", "near"});
  system.caps.push_back({"end", "far"});
  system.bodies.push_back({"other", {"arm", "pad", "end"}, 1.5, {}});
  cut(system, 1);
  const films::FilmComplex start = start::build_start(system, 0.15);
  for (const films::ComplexBody& body : start.bodies) {
    EXPECT_THAT(check_surface(films::body_surface(start, body)), IsEmpty());
  }
  EXPECT_NEAR(surface_area(start.mesh, start.mesh.label_of("pad")),
              0.25 * std::numbers::pi, kChords);
  for (const films::ComplexEdge& mark : start.edges) {
    const Vec3& a = start.mesh.points[mark.a];
    EXPECT_GT(a.z(), -1.0) << "an edge of the held film slides at "
                           << a.transpose();
  }
}

TEST(CutFilms, WhatCannotBeCutIsToldByName) {
  const auto expect_refused = [](const films::FilmSystem& system,
                                 const char* text) {
    try {
      static_cast<void>(start::build_start(system, 0.25));
      ADD_FAILURE() << text;
    } catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), HasSubstr(text));
    }
  };
  films::FilmSystem beyond = tube(4.0);
  cut(beyond, 1);
  beyond.caps[2].wall->at.x() = -3.0;
  expect_refused(beyond, "lies beyond a plane of symmetry");
  films::FilmSystem aslant = bored(0.4);
  std::get<curves::Circle>(aslant.curves[3].shape).center.x() = 0.1;
  cut(aslant, 1);
  expect_refused(aslant, "plane of symmetry cuts");
}

}  // namespace
}  // namespace meniscus::cut_films_test
