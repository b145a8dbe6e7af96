#include "tests/support/systems.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numbers>
#include <set>

#include "evolve/groom/surface_editor.h"

namespace meniscus::systems {

namespace {

curves::Curve circle(const char* name, const Vec3& center, const Vec3& normal,
                     double radius) {
  return {name, curves::Circle{center, normal, radius}};
}

}  // namespace

films::FilmSystem bracket() {
  const double s = std::sin(std::numbers::pi / 3.0);
  films::FilmSystem system;
  system.curves = {
      circle("support", Vec3::Zero(), -Vec3::UnitZ(), 35.0),
      circle("left", Vec3(-120.0, 0.0, 72.0), Vec3(-s, 0.0, 0.5), 50.0),
      circle("right", Vec3(120.0, 0.0, 72.0), Vec3(s, 0.0, 0.5), 50.0)};
  system.films = {
      {"skin", films::FilmKind::Branch, {"support", "left", "right"}, 1.0}};
  system.caps = {
      {"support_pad", "support"}, {"left_pad", "left"}, {"right_pad", "right"}};
  system.bodies = {
      {"part", {"skin", "support_pad", "left_pad", "right_pad"}, 1.7e6, {}}};
  return system;
}

films::FilmSystem catenoid() {
  films::FilmSystem system;
  system.curves = {circle("low", -0.5 * Vec3::UnitZ(), Vec3::UnitZ(), 1.0),
                   circle("high", 0.5 * Vec3::UnitZ(), Vec3::UnitZ(), 1.0)};
  system.films = {{"film", films::FilmKind::Loft, {"low", "high"}, 1.0}};
  return system;
}

films::FilmSystem cylinder(double length) {
  films::FilmSystem system;
  system.curves = {circle("low", Vec3::Zero(), -Vec3::UnitZ(), 1.0),
                   circle("high", length * Vec3::UnitZ(), Vec3::UnitZ(), 1.0)};
  system.films = {{"film", films::FilmKind::Loft, {"low", "high"}, 1.0}};
  system.caps = {{"bottom", "low"}, {"top", "high"}};
  system.bodies = {{"body", {"film", "bottom", "top"}, {}, 1.0}};
  return system;
}

films::FilmSystem strut() {
  films::FilmSystem system;
  curves::Rectangle square;
  square.width = 2.0;
  square.height = 2.0;
  system.curves = {{"square", square},
                   circle("circle", Vec3(0.8, 0.0, 4.0), Vec3::UnitZ(), 0.6)};
  system.films = {{"film", films::FilmKind::Loft, {"square", "circle"}, 1.0}};
  system.caps = {{"base", "square"}, {"top", "circle"}};
  system.bodies = {{"body", {"film", "base", "top"}, 14.0, {}}};
  return system;
}

films::FilmSystem bulkhead() {
  films::FilmSystem system;
  system.curves = {circle("low", -2.0 * Vec3::UnitZ(), Vec3::UnitZ(), 1.0),
                   circle("middle", Vec3::Zero(), Vec3::UnitZ(), 1.2),
                   circle("high", 2.0 * Vec3::UnitZ(), Vec3::UnitZ(), 1.0)};
  system.films = {{"lower", films::FilmKind::Loft, {"low", "middle"}, 1.0},
                  {"upper", films::FilmKind::Loft, {"middle", "high"}, 1.0},
                  {"wall", films::FilmKind::Disk, {"middle"}, 1.0}};
  system.caps = {{"bottom", "low"}, {"top", "high"}};
  system.bodies = {{"below", {"lower", "wall", "bottom"}, 7.0, {}},
                   {"above", {"upper", "wall", "top"}, 8.0, {}}};
  return system;
}

Quality quality(const films::FilmComplex& complex, Part part) {
  const SurfaceMesh& mesh = complex.mesh;
  Quality q{180.0, 180.0, 1e300, 0.0, 0.0};
  int edges = 0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const bool liquid = complex.surfaces[mesh.facet_label[f]].liquid;
    if (liquid != (part == Part::Films)) {
      continue;
    }
    const Triangle& t = mesh.facets[f];
    const double angle =
        films::smallest_angle(mesh.points[t[0]], mesh.points[t[1]],
                              mesh.points[t[2]]) *
        180.0 / std::numbers::pi;
    q.smallest_angle = std::min(q.smallest_angle, angle);
    const bool inner = std::none_of(t.begin(), t.end(), [&](int v) {
      return complex.vertices[v].kind == films::VertexKind::OnCurve;
    });
    if (inner) {
      q.smallest_inner_angle = std::min(q.smallest_inner_angle, angle);
    }
    for (int k = 0; k < 3; ++k) {
      const double length =
          (mesh.points[t[k]] - mesh.points[t[(k + 1) % 3]]).norm();
      q.shortest = std::min(q.shortest, length);
      q.longest = std::max(q.longest, length);
      q.mean += length;
      ++edges;
    }
  }
  q.mean /= std::max(edges, 1);
  return q;
}

int euler_characteristic(const SurfaceMesh& mesh) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  std::set<int> used;
  for (const Triangle& t : mesh.facets) {
    used.insert(t.begin(), t.end());
  }
  return static_cast<int>(used.size()) - static_cast<int>(edges.size()) +
         static_cast<int>(mesh.facets.size());
}

int open_edges(const SurfaceMesh& mesh) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  std::vector<int> count(edges.size(), 0);
  for (const Triangle& t : facet_edges) {
    for (const int e : t) {
      ++count[e];
    }
  }
  return static_cast<int>(std::count(count.begin(), count.end(), 1));
}

double smallest_angle_deg(const SurfaceMesh& mesh) {
  double least = 180.0;
  for (const Triangle& t : mesh.facets) {
    least = std::min(least,
                     films::smallest_angle(mesh.points[t[0]], mesh.points[t[1]],
                                           mesh.points[t[2]]));
  }
  return least * 180.0 / std::numbers::pi;
}

bool identical(const films::FilmComplex& a, const films::FilmComplex& b) {
  const auto same_points = [](const Points& p, const Points& q) {
    return p.size() == q.size() &&
           std::equal(p.begin(), p.end(), q.begin(),
                      [](const Vec3& u, const Vec3& v) {
                        // Not ==, for which 0 is -0 and NaN is not NaN.
                        const auto bits = [](const Vec3& w) {
                          return std::array{std::bit_cast<std::uint64_t>(w[0]),
                                            std::bit_cast<std::uint64_t>(w[1]),
                                            std::bit_cast<std::uint64_t>(w[2])};
                        };
                        return bits(u) == bits(v);
                      });
  };
  const bool same_vertices =
      a.vertices.size() == b.vertices.size() &&
      std::equal(
          a.vertices.begin(), a.vertices.end(), b.vertices.begin(),
          [](const films::ComplexVertex& u, const films::ComplexVertex& v) {
            return u.kind == v.kind && u.curve == v.curve && u.t == v.t;
          });
  return same_points(a.mesh.points, b.mesh.points) && same_vertices &&
         a.mesh.facets == b.mesh.facets &&
         a.mesh.facet_label == b.mesh.facet_label;
}

}  // namespace meniscus::systems
