/// What the tests of grooming measure on complexes that are not manifold.
#pragma once

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "core/geometry/edge_key.h"
#include "core/math/union_find.h"
#include "evolve/films/film_complex.h"

namespace meniscus::nonmanifold {

/// Facets per edge.
inline std::map<Edge, std::vector<int>> edge_facets(const SurfaceMesh& mesh) {
  std::map<Edge, std::vector<int>> uses;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.facets[f][k];
      const int b = mesh.facets[f][(k + 1) % 3];
      uses[edge_key(a, b)].push_back(static_cast<int>(f));
    }
  }
  return uses;
}

/// Edges with `films` facets.
inline int count_edges(const SurfaceMesh& mesh, std::size_t films) {
  const auto uses = edge_facets(mesh);
  return static_cast<int>(std::count_if(
      uses.begin(), uses.end(),
      [&](const auto& use) { return use.second.size() == films; }));
}

/// A line of a film complex: the films along it, and its ends.
struct Lines {
  std::map<std::vector<int>, int> of_films;  // labels -> connected lines
  int junctions = 0;                         // points where lines meet
};

/// The lines of edges with three or more facets.
inline Lines triple_lines(const SurfaceMesh& mesh) {
  std::map<std::vector<int>, std::vector<Edge>> edges;
  std::map<int, int> valence;
  for (const auto& [edge, facets] : edge_facets(mesh)) {
    if (facets.size() < 3) {
      continue;
    }
    std::vector<int> labels;
    for (const int f : facets) {
      labels.push_back(mesh.facet_label[f]);
    }
    std::sort(labels.begin(), labels.end());
    edges[labels].push_back(edge);
    ++valence[edge[0]];
    ++valence[edge[1]];
  }
  Lines lines;
  for (const auto& [labels, list] : edges) {
    UnionFind joined(mesh.points.size());
    for (const Edge& e : list) {
      joined.join(e[0], e[1]);
    }
    std::set<int> roots;
    for (const Edge& e : list) {
      roots.insert(joined.root(e[0]));
    }
    lines.of_films[labels] = static_cast<int>(roots.size());
  }
  for (const auto& [v, count] : valence) {
    lines.junctions += count > 2 ? 1 : 0;
  }
  return lines;
}

/// Connected parts of the facets, across shared points.
inline int components(const SurfaceMesh& mesh) {
  UnionFind joined(mesh.points.size());
  for (const Triangle& t : mesh.facets) {
    joined.join(t[0], t[1]);
    joined.join(t[1], t[2]);
  }
  std::set<int> roots;
  for (const Triangle& t : mesh.facets) {
    roots.insert(joined.root(t[0]));
  }
  return static_cast<int>(roots.size());
}

/// Free vertices without constraints moved by up to `size` a coordinate.
inline void shake(films::FilmComplex& complex, double size, unsigned seed) {
  std::mt19937 random(seed);
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    if (complex.vertices[v].kind == films::VertexKind::Free &&
        complex.vertices[v].constraints < 0) {
      for (int k = 0; k < 3; ++k) {
        complex.mesh.points[v][k] +=
            size * (random() / static_cast<double>(std::mt19937::max()) - 0.5);
      }
    }
  }
}

}  // namespace meniscus::nonmanifold
