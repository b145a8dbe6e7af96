/// What the tests of grooming measure on complexes that are not manifold.
#pragma once

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::nonmanifold {

/// Facets per edge.
inline std::map<Edge, std::vector<int>> edge_facets(const SurfaceMesh& mesh) {
  std::map<Edge, std::vector<int>> uses;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.facets[f][k];
      const int b = mesh.facets[f][(k + 1) % 3];
      uses[{std::min(a, b), std::max(a, b)}].push_back(static_cast<int>(f));
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
    std::map<int, int> root;
    const auto find = [&](int v) {
      root.emplace(v, v);
      while (root[v] != v) {
        v = root[v];
      }
      return v;
    };
    for (const Edge& e : list) {
      root[find(e[0])] = find(e[1]);
    }
    std::set<int> roots;
    for (const auto& [v, up] : root) {
      roots.insert(find(v));
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
  std::vector<int> root(mesh.points.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[v] != v) {
      v = root[v] = root[root[v]];
    }
    return v;
  };
  for (const Triangle& t : mesh.facets) {
    root[find(t[0])] = find(t[1]);
    root[find(t[1])] = find(t[2]);
  }
  std::set<int> roots;
  for (const Triangle& t : mesh.facets) {
    roots.insert(find(t[0]));
  }
  return static_cast<int>(roots.size());
}

/// Free vertices without constraints moved by up to `size` a coordinate.
inline void shake(FilmComplex& complex, double size, unsigned seed) {
  std::mt19937 random(seed);
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    if (complex.vertices[v].kind == VertexKind::Free &&
        complex.vertices[v].constraints < 0) {
      for (int k = 0; k < 3; ++k) {
        complex.mesh.points[v][k] +=
            size * (random() / static_cast<double>(std::mt19937::max()) - 0.5);
      }
    }
  }
}

}  // namespace meniscus::nonmanifold
