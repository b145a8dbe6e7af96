#include "evolve/groom/film_cutter.h"

#include <algorithm>

#include <fmt/format.h>

namespace meniscus::groom {

FilmCutter::FilmCutter(films::FilmComplex& complex)
    : complex_(complex),
      marks_(complex),
      star_(complex.mesh.points.size()),
      on_mark_(complex.mesh.points.size(), 0) {
  for (int f = 0; f < static_cast<int>(complex.mesh.facets.size()); ++f) {
    for (const int v : facet(f)) {
      star_[v].push_back(f);
    }
  }
  for (const films::ComplexEdge& mark : marks_.all()) {
    on_mark_[mark.a] = 1;
    on_mark_[mark.b] = 1;
  }
}

std::vector<int> FilmCutter::neighbours(int v) const {
  std::vector<int> result;
  for (const int f : star_[v]) {
    for (const int u : facet(f)) {
      if (u != v) {
        result.push_back(u);
      }
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<int> FilmCutter::along(int a, int b) const {
  std::vector<int> result;
  for (const int f : star_[a]) {
    const Triangle& t = facet(f);
    if (t[0] == b || t[1] == b || t[2] == b) {
      result.push_back(f);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

int FilmCutter::corner_off(int f, int a, int b) const {
  const Triangle& t = facet(f);
  return *std::find_if(t.begin(), t.end(),
                       [&](int v) { return v != a && v != b; });
}

bool FilmCutter::is_loose(int v) const {
  const films::ComplexVertex& vertex = complex_.vertices[v];
  return vertex.kind == films::VertexKind::Free && vertex.constraints < 0 &&
         on_mark_[v] == 0 &&
         std::all_of(star_[v].begin(), star_[v].end(),
                     [&](int f) { return is_liquid(f); });
}

int FilmCutter::body_at(int f, Side side) const {
  const int sign = side == Side::Behind ? 1 : -1;
  for (std::size_t b = 0; b < complex_.bodies.size(); ++b) {
    for (const films::BodySide& part : complex_.bodies[b].sides) {
      if (part.surface == label(f) && part.sign == sign) {
        return static_cast<int>(b);
      }
    }
  }
  return -1;
}

int FilmCutter::add_vertex(const Vec3& place) {
  complex_.mesh.points.push_back(place);
  complex_.vertices.emplace_back();
  star_.emplace_back();
  on_mark_.push_back(0);
  return static_cast<int>(complex_.mesh.points.size()) - 1;
}

void FilmCutter::add_facet(const Triangle& corners, int label) {
  for (const int v : corners) {
    star_[v].push_back(static_cast<int>(complex_.mesh.facets.size()));
  }
  complex_.mesh.facets.push_back(corners);
  complex_.mesh.facet_label.push_back(label);
}

void FilmCutter::replace(int f, int from, int to) {
  for (int& v : complex_.mesh.facets[f]) {
    if (v == from) {
      v = to;
      star_[from].erase(std::find(star_[from].begin(), star_[from].end(), f));
      star_[to].push_back(f);
    }
  }
}

void FilmCutter::remove(int f) {
  for (const int v : facet(f)) {
    star_[v].erase(std::find(star_[v].begin(), star_[v].end(), f));
  }
  complex_.mesh.facets[f] = {-1, -1, -1};
}

int FilmCutter::add_surface(int like, int ahead, int behind) {
  const int id = static_cast<int>(complex_.surfaces.size());
  films::ComplexSurface surface = complex_.surfaces[like];
  int number = 1;
  do {
    surface.name = fmt::format("popped{}", number++);
  } while (complex_.mesh.label_of(surface.name) >= 0);
  surface.pulled_from = complex_.surfaces[like].numbers_of();
  complex_.mesh.labels.push_back(surface.name);
  complex_.surfaces.push_back(std::move(surface));
  for (films::FilmQuantity& quantity : complex_.quantities) {
    if (std::count(quantity.surfaces.begin(), quantity.surfaces.end(), like) >
        0) {
      quantity.surfaces.push_back(id);
    }
  }
  if (ahead != behind) {
    if (ahead >= 0) {
      complex_.bodies[ahead].sides.push_back({id, -1});
    }
    if (behind >= 0) {
      complex_.bodies[behind].sides.push_back({id, 1});
    }
  }
  return id;
}

void FilmCutter::tidy() {
  SurfaceMesh& mesh = complex_.mesh;
  // Marks of collapsed edges, whose ends became one, go.
  auto& edges = complex_.edges;
  edges.erase(std::remove_if(edges.begin(), edges.end(),
                             [](const films::ComplexEdge& edge) {
                               return edge.a == edge.b;
                             }),
              edges.end());
  // A vertex stays while a live facet or a mark names it; the rest are numbered
  // anew in their old order.
  std::vector<int> number(mesh.points.size(), -1);
  for (const Triangle& t : mesh.facets) {
    for (const int v : t) {
      if (v >= 0) {
        number[v] = 0;
      }
    }
  }
  for (const films::ComplexEdge& edge : edges) {
    number[edge.a] = 0;
    number[edge.b] = 0;
  }
  int points = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) {
      mesh.points[points] = mesh.points[v];
      complex_.vertices[points] = complex_.vertices[v];
      number[v] = points++;
    }
  }
  mesh.points.resize(points);
  complex_.vertices.resize(points);
  // Marks and live facets by the new numbers, facets packed in place.
  for (films::ComplexEdge& edge : edges) {
    edge.a = number[edge.a];
    edge.b = number[edge.b];
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Triangle& t = mesh.facets[f];
    if (t[0] >= 0) {
      mesh.facets[kept] = {number[t[0]], number[t[1]], number[t[2]]};
      mesh.facet_label[kept++] = mesh.facet_label[f];
    }
  }
  mesh.facets.resize(kept);
  mesh.facet_label.resize(kept);
}

}  // namespace meniscus::groom
