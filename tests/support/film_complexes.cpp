#include "tests/support/film_complexes.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "tests/support/complex_builder.h"

namespace meniscus::test_films {

namespace {

using std::numbers::pi;

curves::CurveShape ring_at(double z, double radius = 1.0, double x = 0.0) {
  return curves::Circle{Vec3(x, 0.0, z), Vec3::UnitZ(), radius};
}

// Free vertices on the circle of radius r at height z about the z axis.
std::vector<int> free_ring(ComplexBuilder& builder, int n, double radius,
                           double z) {
  std::vector<int> ring;
  for (int i = 0; i < n; ++i) {
    const double a = 2.0 * pi * i / n;
    ring.push_back(
        builder.vertex(Vec3(radius * std::cos(a), radius * std::sin(a), z)));
  }
  return ring;
}

std::vector<int> reversed(const std::vector<int>& ring) {
  return {ring.rbegin(), ring.rend()};
}

// Bands between `lower` and `upper` through rows - 1 rings on straight lines.
void ruled_bands(ComplexBuilder& builder, int surface,
                 const std::vector<int>& lower, const std::vector<int>& upper,
                 int rows) {
  std::vector<int> below = lower;
  for (int row = 1; row <= rows; ++row) {
    std::vector<int> above = upper;
    if (row < rows) {
      const double w = static_cast<double>(row) / rows;
      for (std::size_t i = 0; i < above.size(); ++i) {
        above[i] = builder.vertex((1.0 - w) * builder.place(lower[i]) +
                                  w * builder.place(upper[i]));
      }
    }
    builder.band(surface, below, above);
    below = above;
  }
}

// The faces of the box from `low` to `high` whose bit is set: x0 x1 y0 y1 z0
// z1 from the lowest bit.
void box_faces(ComplexBuilder& builder, int surface, const Vec3& low,
               const Vec3& high, int n, unsigned faces) {
  const Vec3 size = high - low;
  for (unsigned face = 0; face < 6; ++face) {
    if ((faces & (1U << face)) == 0) {
      continue;
    }
    const unsigned axis = face / 2;
    Vec3 u = Vec3::Unit((axis + 1) % 3).cwiseProduct(size);
    Vec3 v = Vec3::Unit((axis + 2) % 3).cwiseProduct(size);
    Vec3 origin = low;
    if (face % 2 == 1) {
      origin[axis] = high[axis];
    } else {
      std::swap(u, v);
    }
    builder.plate(surface, origin, u, v, n);
  }
}

constexpr unsigned kAllFaces = 0b111111;

}  // namespace

films::FilmComplex catenoid_start(int around, int rows) {
  ComplexBuilder builder;
  const int film = builder.liquid("film");
  const int low = builder.curve("low", ring_at(-0.5));
  const int high = builder.curve("high", ring_at(0.5));
  const std::vector<int> lower = builder.rim(low, around);
  const std::vector<int> upper = builder.rim(high, around);
  std::vector<int> below = lower;
  for (int row = 1; row <= rows; ++row) {
    // On the cylinder itself: chords of the rims would be inside it.
    const std::vector<int> above =
        row < rows ? free_ring(builder, around, 1.0,
                               -0.5 + static_cast<double>(row) / rows)
                   : upper;
    builder.band(film, below, above);
    below = above;
  }
  return builder.complex();
}

films::FilmComplex cube_start(int n) {
  ComplexBuilder builder;
  const int film = builder.liquid("film");
  box_faces(builder, film, Vec3::Zero(), Vec3::Ones(), n, kAllFaces);
  builder.complex().bodies = {
      {.name = "drop", .sides = {{film, 1}}, .volume = 1.0}};
  return builder.complex();
}

films::FilmComplex strut_start(int around, int rows) {
  ComplexBuilder builder;
  const int film = builder.liquid("film");
  const int foot = builder.solid("foot");
  const int head = builder.solid("head");
  const int square = builder.curve(
      "square", curves::Polygon{{Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0),
                                 Vec3(-1, -1, 0)}});
  const int circle = builder.curve("circle", ring_at(4.0, 0.6, 0.8));
  const std::vector<int> lower = builder.rim(square, around);
  // The square begins at a corner, at -45 degrees.
  const std::vector<int> upper = builder.rim(circle, around, -0.125);
  ruled_bands(builder, film, lower, upper, rows);
  builder.fan(foot, reversed(lower), films::VertexKind::InCap);
  builder.fan(head, upper, films::VertexKind::InCap);
  builder.complex().bodies = {{.name = "strut",
                               .sides = {{film, 1}, {foot, 1}, {head, 1}},
                               .volume = 14.0}};
  return builder.complex();
}

films::FilmComplex triple_disk_start() {
  constexpr int kAround = 12;
  ComplexBuilder builder;
  const int lower = builder.liquid("lower");
  const int upper = builder.liquid("upper");
  const int disk = builder.liquid("disk");
  const int low = builder.curve("low", ring_at(-0.3));
  const int high = builder.curve("high", ring_at(0.3));
  const std::vector<int> bottom = builder.rim(low, kAround);
  const std::vector<int> top = builder.rim(high, kAround);
  const std::vector<int> middle = free_ring(builder, kAround, 0.8, 0.0);
  builder.band(lower, bottom, middle);
  builder.band(upper, middle, top);
  builder.fan(disk, middle, films::VertexKind::Free);
  return builder.complex();
}

films::FilmComplex cube_frame_start() {
  ComplexBuilder builder;
  std::array<int, 4> top{};
  std::array<int, 4> bottom{};
  std::array<int, 4> inner{};
  constexpr std::array<std::array<double, 2>, 4> kCorner = {
      {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};
  for (int i = 0; i < 4; ++i) {
    const auto [x, y] = kCorner[i];
    top[i] = builder.vertex(0.5 * Vec3(x, y, 1), films::VertexKind::Fixed);
    bottom[i] = builder.vertex(0.5 * Vec3(x, y, -1), films::VertexKind::Fixed);
    inner[i] = builder.vertex(0.1 * Vec3(x, y, 0));
  }
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    builder.quad_about_centre(builder.liquid(fmt::format("top{}", i)), top[i],
                              top[j], inner[j], inner[i]);
    builder.quad_about_centre(builder.liquid(fmt::format("bottom{}", i)),
                              bottom[i], bottom[j], inner[j], inner[i]);
    builder.facet(builder.liquid(fmt::format("side{}", i)), bottom[i], top[i],
                  inner[i]);
    builder.fixed_edge(top[i], top[j]);
    builder.fixed_edge(bottom[i], bottom[j]);
    builder.fixed_edge(bottom[i], top[i]);
  }
  builder.quad_about_centre(builder.liquid("square"), inner[0], inner[1],
                            inner[2], inner[3]);
  return builder.complex();
}

films::FilmComplex tetrahedral_frame_start() {
  ComplexBuilder builder;
  std::array<int, 4> corner{};
  std::array<int, 4> spoke{};  // middles of the triple lines
  const std::array<Vec3, 4> places = {Vec3(1, 1, 1), Vec3(1, -1, -1),
                                      Vec3(-1, 1, -1), Vec3(-1, -1, 1)};
  const Vec3 off(0.2, 0.1, -0.15);
  const int centre = builder.vertex(off);
  for (int i = 0; i < 4; ++i) {
    corner[i] = builder.vertex(places[i], films::VertexKind::Fixed);
    spoke[i] = builder.vertex(0.5 * (places[i] + off));
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      const int film = builder.liquid(fmt::format("film{}{}", i, j));
      const int middle = builder.vertex(0.5 * (places[i] + places[j]),
                                        films::VertexKind::Fixed);
      builder.fixed_edge(corner[i], middle);
      builder.fixed_edge(middle, corner[j]);
      builder.facet(film, corner[i], middle, spoke[i]);
      builder.facet(film, middle, corner[j], spoke[j]);
      builder.facet(film, middle, spoke[j], spoke[i]);
      builder.facet(film, spoke[i], spoke[j], centre);
    }
  }
  return builder.complex();
}

films::FilmComplex double_bubble_start(int n) {
  ComplexBuilder builder;
  const int left = builder.liquid("left");
  const int right = builder.liquid("right");
  const int middle = builder.liquid("middle");
  const Vec3 low(-1.0, -0.5, -0.5);
  const Vec3 high(1.0, 0.5, 0.5);
  const Vec3 half(1.0, 0.0, 0.0);
  box_faces(builder, left, low, high - half, n, kAllFaces & ~0b000010U);
  box_faces(builder, right, low + half, high, n, kAllFaces & ~0b000001U);
  box_faces(builder, middle, low, high - half, n, 0b000010U);
  builder.complex().bodies = {
      {.name = "left", .sides = {{left, 1}, {middle, 1}}, .volume = 1.0},
      {.name = "right", .sides = {{right, 1}, {middle, -1}}, .volume = 1.0}};
  return builder.complex();
}

films::FilmComplex sessile_cap_start(double angle, int n) {
  ComplexBuilder builder;
  const int film = builder.liquid("film");
  box_faces(builder, film, Vec3::Zero(), Vec3::Ones(), n,
            kAllFaces & ~0b010000U);
  films::FilmComplex& complex = builder.complex();
  complex.level_sets = {
      {.name = "plane", .formula = Expression::parse("z", {"x", "y", "z"})}};
  complex.constraint_sets = {{0}};
  // Counter-clockwise along the rim, y dx adds up to minus the wetted area.
  complex.integrals = {
      {.name = "wall",
       .role = films::LineIntegral::Role::Energy,
       .field = {Expression::parse(fmt::format("{:.17g} * y", std::cos(angle)),
                                   {"x", "y", "z"}),
                 Expression(), Expression()}}};
  complex.integral_sets = {{0}};
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(complex.mesh.facets, edges, facet_edges);
  for (const Triangle& facet : complex.mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      const int a = facet[k];
      const int b = facet[(k + 1) % 3];
      if (builder.place(a).z() == 0.0 && builder.place(b).z() == 0.0) {
        complex.vertices[a].constraints = 0;
        complex.edges.push_back(
            {.a = a, .b = b, .constraints = 0, .integrals = 0});
      }
    }
  }
  complex.bodies = {{.name = "drop", .sides = {{film, 1}}, .volume = 1.0}};
  complex.volume_rule = films::VolumeRule::Column;
  return complex;
}

films::FilmComplex tube_start(const TubeSpec& spec) {
  ComplexBuilder builder;
  const int film = builder.liquid("film");
  const int foot = builder.solid("foot");
  const int head = builder.solid("head");
  const int low = builder.curve("low", ring_at(0.0, spec.radius));
  const int high = builder.curve("high", ring_at(spec.length, spec.radius));
  const std::vector<int> lower = builder.rim(low, spec.around);
  const std::vector<int> upper = builder.rim(high, spec.around);
  ruled_bands(builder, film, lower, upper, spec.rows);
  builder.fan(foot, reversed(lower), films::VertexKind::InCap);
  builder.fan(head, upper, films::VertexKind::InCap);
  builder.complex().bodies = {{.name = "tube",
                               .sides = {{film, 1}, {foot, 1}, {head, 1}},
                               .volume = spec.volume,
                               .pressure = spec.pressure}};
  return builder.complex();
}

double prism_volume(const TubeSpec& spec) {
  return 0.5 * spec.around * std::sin(2.0 * pi / spec.around) * spec.radius *
         spec.radius * spec.length;
}

double prism_pressure(const TubeSpec& spec) {
  return 1.0 / (spec.radius * std::cos(pi / spec.around));
}

films::FilmComplex long_tube_saddle(int around, int rows) {
  TubeSpec spec{.length = 6.5, .around = around, .rows = rows};
  spec.volume = prism_volume(spec);
  return tube_start(spec);
}

films::FilmComplex thin_catenoid_saddle(int around, int rows) {
  // c cosh(0.5 / c) falls to its least value at c = 0.4168; the thin branch is
  // left of it.
  double low = 0.1;
  double high = 0.4;
  for (int step = 0; step < 60; ++step) {
    const double c = 0.5 * (low + high);
    (c * std::cosh(0.5 / c) > 1.0 ? low : high) = c;
  }
  films::FilmComplex complex = catenoid_start(around, rows);
  const double c = low;
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    if (complex.vertices[v].kind == films::VertexKind::Free) {
      Vec3& p = complex.mesh.points[v];
      // Rows closer where the profile is narrow: equal steps of arclength.
      const double s = 2.0 * p.z() * c * std::sinh(0.5 / c);
      const double z = c * std::asinh(s / c);
      const double r = c * std::cosh(z / c);
      p = Vec3(r * p.x(), r * p.y(), z);
    }
  }
  return complex;
}

films::FilmComplex fins_start(const std::vector<double>& degrees, int along) {
  ComplexBuilder builder;
  std::vector<int> line;
  for (int i = 0; i <= along; ++i) {
    line.push_back(builder.vertex(Vec3(0, 0, 4.0 * i / along)));
  }
  for (const int end : {0, along}) {
    builder.complex().vertices[line[end]].kind = films::VertexKind::Fixed;
  }
  for (const double angle : degrees) {
    const double a = angle * pi / 180.0;
    const Vec3 out(2.0 * std::cos(a), 2.0 * std::sin(a), 0.0);
    const int film = builder.liquid("fin" + std::to_string(int(angle)));
    std::vector<int> rim;
    for (const int v : line) {
      rim.push_back(
          builder.vertex(builder.place(v) + out, films::VertexKind::Fixed));
    }
    for (int i = 0; i < along; ++i) {
      builder.quad(film, line[i], rim[i], rim[i + 1], line[i + 1]);
      builder.fixed_edge(rim[i], rim[i + 1]);
    }
    builder.fixed_edge(line[0], rim[0]);
    builder.fixed_edge(line[along], rim[along]);
  }
  return builder.complex();
}

}  // namespace meniscus::test_films
