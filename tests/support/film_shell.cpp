#include "tests/support/film_shell.h"

#include <map>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "evolve/walls/thicken.h"
#include "mesh_tet/quadratic.h"
#include "mesh_tet/tetrahedralize.h"

namespace meniscus::test_films {

namespace {

/// One film of a surface: corners first, then mid-sides.
struct Film {
  int corners = 0;
  Points points;
  std::vector<Triangle> facets;  // of corners
  std::map<Edge, int> middle;    // of an edge of corners
};

Film film_of(const QuadraticSurface& surface, int label) {
  Film film;
  std::map<int, int> corner;
  for (std::size_t f = 0; f < surface.base.facets.size(); ++f) {
    if (surface.base.facet_label[f] == label) {
      for (const int v : surface.base.facets[f]) {
        corner.try_emplace(v, 0);
      }
    }
  }
  for (auto& [old, now] : corner) {
    now = film.corners++;
    film.points.push_back(surface.base.points[old]);
  }
  for (std::size_t f = 0; f < surface.base.facets.size(); ++f) {
    if (surface.base.facet_label[f] != label) {
      continue;
    }
    Triangle facet;
    for (int k = 0; k < 3; ++k) {
      facet[k] = corner[surface.base.facets[f][k]];
    }
    film.facets.push_back(facet);
    for (int k = 0; k < 3; ++k) {
      const Edge edge = edge_key(facet[k], facet[(k + 1) % 3]);
      if (film.middle.try_emplace(edge, static_cast<int>(film.points.size()))
              .second) {
        film.points.push_back(surface.mid[surface.facet_edges[f][k]]);
      }
    }
  }
  return film;
}

/// The film with each facet in four.
SurfaceMesh refined(const Film& film) {
  SurfaceMesh mesh;
  mesh.points = film.points;
  mesh.labels = {"film"};
  for (const Triangle& t : film.facets) {
    const int ab = film.middle.at(edge_key(t[0], t[1]));
    const int bc = film.middle.at(edge_key(t[1], t[2]));
    const int ca = film.middle.at(edge_key(t[2], t[0]));
    for (const Triangle& part :
         {Triangle{t[0], ab, ca}, Triangle{t[1], bc, ab},
          Triangle{t[2], ca, bc}, Triangle{ab, bc, ca}}) {
      mesh.facets.push_back(part);
    }
  }
  mesh.facet_label.assign(mesh.facets.size(), 0);
  return mesh;
}

/// Front, back and one row of quads along each rim. Corner v is v on the front
/// and v + corners on the back.
SurfaceMesh coarse_wall(const Film& film, const Points& front,
                        const Points& back, const ShellSpec& spec) {
  SurfaceMesh wall;
  wall.labels = {"front", "back"};
  const int n = film.corners;
  wall.points.assign(front.begin(), front.begin() + n);
  wall.points.insert(wall.points.end(), back.begin(), back.begin() + n);
  const auto add = [&](int a, int b, int c, int label) {
    wall.facets.push_back({a, b, c});
    wall.facet_label.push_back(label);
  };
  std::map<Edge, int> uses;
  for (const Triangle& t : film.facets) {
    add(t[0], t[1], t[2], 0);
    add(t[0] + n, t[2] + n, t[1] + n, 1);
    for (int k = 0; k < 3; ++k) {
      ++uses[edge_key(t[k], t[(k + 1) % 3])];
    }
  }
  for (const Triangle& t : film.facets) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      if (uses[edge_key(a, b)] != 1) {
        continue;
      }
      const std::string name = spec.rim(film.points[a]);
      int label = wall.label_of(name);
      if (label < 0) {
        label = static_cast<int>(wall.labels.size());
        wall.labels.push_back(name);
      }
      add(b, a, a + n, label);
      add(b, a + n, b + n, label);
    }
  }
  return wall;
}

}  // namespace

TetMesh film_shell(const QuadraticSurface& surface, const ShellSpec& spec) {
  const Film film = film_of(surface, surface.base.label_of(spec.film));
  const walls::ThickWall thick =
      walls::thicken(refined(film), {.thickness = Expression(spec.thickness)});
  if (!thick.findings.empty()) {
    throw MeshError(summary(thick.findings));
  }
  const auto all = static_cast<std::ptrdiff_t>(film.points.size());
  const auto first = thick.surface.points.begin();
  const Points front(first, first + all);
  const Points back(first + all, first + 2 * all);
  QuadraticSurface wall;
  wall.base = coarse_wall(film, front, back, spec);
  list_edges(wall.base.facets, wall.edges, wall.facet_edges);
  const int n = film.corners;
  for (const auto& [p, q] : wall.edges) {
    const int a = p % n;
    const int b = q % n;
    if (a == b) {  // across the wall
      wall.mid.push_back(0.5 * (wall.base.points[p] + wall.base.points[q]));
      continue;
    }
    const int m = film.middle.at(edge_key(a, b));
    const double across = 0.5 * ((p < n ? 1.0 : 0.0) + (q < n ? 1.0 : 0.0));
    wall.mid.push_back(across * front[m] + (1.0 - across) * back[m]);
  }
  const mesh_tet::Tetrahedralization filled =
      mesh_tet::tetrahedralize(wall.base);
  if (filled.failure) {
    throw MeshError(filled.failure->message);
  }
  return mesh_tet::make_quadratic(filled.mesh, wall);
}

}  // namespace meniscus::test_films
