// Films against closed forms: area, pressure, place and the angle of 120
// degrees, each over nested refinements, at the order that linear facets have.
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/delaunay_curves.h"
#include "tests/support/film_complexes.h"
#include "tests/support/film_race.h"

namespace meniscus {
namespace {

using std::numbers::pi;

// Observed between the last two of three levels; the first of them still has
// edges of a tenth of the film.
constexpr double kSecondOrder = 1.8;

// Largest distance over all vertices: like h^2 log(1/h), and the worst vertex
// changes from level to level.
constexpr double kDistanceOrder = 1.6;

struct Settled {
  FilmComplex complex;
  FilmState state;
};

struct Exact {
  double energy = 0.0;
  double pressure = 0.0;  // 0: no body
  // Distance of a film's point from the exact film; none: not looked at.
  std::function<double(const Vec3&)> distance;
};

struct Errors {
  double energy = 0.0;
  double pressure = 0.0;
  double distance = 0.0;
};

Errors errors_of(const Settled& film, const Exact& exact) {
  Errors errors;
  errors.energy = std::abs(film.state.report.energy - exact.energy);
  for (const BodyState& body : film.state.report.bodies) {
    errors.pressure =
        std::max(errors.pressure, std::abs(body.pressure - exact.pressure));
  }
  for (std::size_t v = 0; v < film.complex.vertices.size(); ++v) {
    if (exact.distance && film.complex.vertices[v].kind == VertexKind::Free) {
      errors.distance = std::max(errors.distance,
                                 exact.distance(film.complex.mesh.points[v]));
    }
  }
  return errors;
}

Settled settled(const FilmComplex& start, int refinements) {
  Settled film{start, {}};
  film.state = find_refined(film.complex, refinements);
  EXPECT_FALSE(film.state.failure) << film.state.report.verdict;
  EXPECT_EQ(film.state.report.verdict, "stable");
  EXPECT_LE(film.state.report.residual, film.state.report.residual_bound);
  return film;
}

void expect_order(double coarse, double fine, const char* what,
                  double least = kSecondOrder) {
  EXPECT_GT(std::log2(coarse / fine), least)
      << what << ": " << coarse << ", " << fine;
}

// `finest`: refinements of the finer of two levels. `bound`: on the relative
// error in energy there.
void expect_second_order(const FilmComplex& start, const Exact& exact,
                         int finest, double bound) {
  const Errors coarse = errors_of(settled(start, finest - 1), exact);
  const Errors fine = errors_of(settled(start, finest), exact);
  expect_order(coarse.energy, fine.energy, "energy");
  EXPECT_LT(fine.energy, bound * exact.energy);
  if (exact.pressure != 0.0) {
    expect_order(coarse.pressure, fine.pressure, "pressure");
  }
  if (exact.distance) {
    expect_order(coarse.distance, fine.distance, "distance", kDistanceOrder);
  }
}

std::function<double(const Vec3&)> from_meridian(const films::Meridian& film,
                                                 double middle) {
  return [film, middle](const Vec3& p) {
    return film.distance(p.head<2>().norm(), p.z() - middle);
  };
}

FilmComplex tube_of(const films::Meridian& film) {
  return films::tube_start({.radius = film.rim().r,
                            .length = 2.0 * film.rim().z,
                            .around = 16,
                            .rows = 8,
                            .volume = film.volume});
}

TEST(ClosedForms, Catenoid) {
  const films::Catenoid exact = films::catenoid(1.0, 1.0);
  const films::Meridian film = films::delaunay_meridian(
      exact.waist, 0.0, exact.waist * std::sinh(0.5 / exact.waist));
  expect_second_order(films::catenoid_start(),
                      {exact.area, 0.0, from_meridian(film, 0.0)}, 3, 1e-3);
}

TEST(ClosedForms, Sphere) {
  const films::Sphere exact = films::sphere_of_volume(1.0);
  const FilmComplex start = films::cube_start();
  expect_second_order(start, {exact.area, exact.pressure, {}}, 3, 1e-3);
  // Its place is free: radii are measured from the middle of its points.
  const Settled film = settled(start, 3);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : film.complex.mesh.points) {
    middle += p / static_cast<double>(film.complex.mesh.points.size());
  }
  for (const Vec3& p : film.complex.mesh.points) {
    EXPECT_NEAR((p - middle).norm(), exact.radius, 1e-2 * exact.radius);
  }
}

TEST(ClosedForms, Cylinder) {
  const films::Meridian film = films::delaunay_meridian(1.0, 1.0, 1.5);
  expect_second_order(tube_of(film), {film.area, 1.0, from_meridian(film, 1.5)},
                      2, 2e-3);
}

TEST(ClosedForms, Unduloid) {
  const films::Meridian film = films::unduloid();
  expect_second_order(
      tube_of(film),
      {film.area, film.pressure, from_meridian(film, film.rim().z)}, 2, 2e-3);
}

TEST(ClosedForms, Nodoid) {
  const films::Meridian film = films::nodoid();
  expect_second_order(
      tube_of(film),
      {film.area, film.pressure, from_meridian(film, film.rim().z)}, 3, 2e-3);
}

TEST(ClosedForms, PlaneDiskIsFlat) {
  // A disk pushed out of its plane comes back: area of the polygon, exactly.
  FilmComplex start = films::tube_start({.around = 12, .rows = 1});
  FilmComplex disk;
  disk.curves = {start.curves[0]};
  disk.mesh.labels = {"disk"};
  disk.surfaces = {{.name = "disk", .tension = 1.0}};
  for (int i = 0; i < 12; ++i) {
    disk.mesh.points.push_back(start.mesh.points[i]);
    disk.vertices.push_back(start.vertices[i]);
    disk.edges.push_back(start.edges[i]);
    disk.mesh.facets.push_back({i, (i + 1) % 12, 12});
  }
  disk.mesh.facet_label.assign(12, 0);
  disk.mesh.points.emplace_back(0.1, 0.2, 0.4);
  disk.vertices.push_back({});
  const Settled film = settled(disk, 3);
  double height = 0.0;
  for (const Vec3& p : film.complex.mesh.points) {
    height = std::max(height, std::abs(p.z()));
  }
  EXPECT_LT(height, 1e-9);  // residual bound over stiffness of one vertex
  EXPECT_NEAR(film.state.report.area, 48.0 * std::sin(pi / 48.0), 1e-9);
}

TEST(ClosedForms, SessileCaps) {
  for (const double degrees : {50.0, 75.0, 90.0, 120.0, 150.0}) {
    SCOPED_TRACE(degrees);
    const double angle = degrees * pi / 180.0;
    const films::SessileCap exact = films::sessile_cap(1.0, angle);
    expect_second_order(films::sessile_cap_start(angle),
                        {exact.energy, exact.pressure, {}}, 3, 1e-3);
  }
}

// Angles between films along triple lines, as facets have them.
struct Angles {
  double worst = 0.0;  // off 120 degrees [degree]
  int edges = 0;
};

Angles triple_angles(const FilmComplex& complex) {
  std::map<Edge, std::vector<Vec3>> out;  // unit vectors away from the edge
  const SurfaceMesh& mesh = complex.mesh;
  for (const Triangle& facet : mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      const int a = facet[k];
      const int b = facet[(k + 1) % 3];
      const Vec3 along = (mesh.points[b] - mesh.points[a]).normalized();
      const Vec3 to = mesh.points[facet[(k + 2) % 3]] - mesh.points[a];
      out[{std::min(a, b), std::max(a, b)}].push_back(
          (to - to.dot(along) * along).normalized());
    }
  }
  Angles angles;
  for (const auto& [edge, films] : out) {
    if (films.size() != 3) {
      continue;
    }
    ++angles.edges;
    for (int k = 0; k < 3; ++k) {
      const double angle = std::acos(films[k].dot(films[(k + 1) % 3]));
      angles.worst =
          std::max(angles.worst, std::abs(angle * 180.0 / pi - 120.0));
    }
  }
  return angles;
}

// Facets beside the line are off the film's tangent by half an edge times its
// curvature: first order.
void expect_120_degrees(const FilmComplex& start, int finest, double bound) {
  constexpr double kFirstOrder = 0.8;
  const Angles coarse = triple_angles(settled(start, finest - 1).complex);
  const Angles fine = triple_angles(settled(start, finest).complex);
  EXPECT_GT(coarse.edges, 0);
  EXPECT_GE(fine.edges, 2 * coarse.edges);
  EXPECT_GT(std::log2(coarse.worst / fine.worst), kFirstOrder)
      << coarse.worst << ", " << fine.worst;
  EXPECT_LT(fine.worst, bound);
}

TEST(ClosedForms, TripleDisk) {
  const films::TripleDisk exact = films::triple_disk();
  expect_second_order(films::triple_disk_start(), {exact.area, 0.0, {}}, 3,
                      1e-3);
  expect_120_degrees(films::triple_disk_start(), 4, 2.5);
}

TEST(ClosedForms, DoubleBubble) {
  const films::DoubleBubble exact = films::double_bubble(1.0);
  expect_second_order(films::double_bubble_start(),
                      {exact.area, exact.pressure, {}}, 3, 1e-3);
  expect_120_degrees(films::double_bubble_start(), 3, 5.0);
}

TEST(ClosedForms, TetrahedralFrameIsExact) {
  const Settled film = settled(films::tetrahedral_frame_start(), 2);
  EXPECT_NEAR(film.state.report.area, films::kTetrahedralFrameArea, 1e-12);
  EXPECT_LT(triple_angles(film.complex).worst, 1e-5);
}

TEST(ClosedForms, CubeFrame) {
  expect_second_order(films::cube_frame_start(),
                      {films::kCubeFrameArea, 0.0, {}}, 4, 1e-4);
}

}  // namespace
}  // namespace meniscus
