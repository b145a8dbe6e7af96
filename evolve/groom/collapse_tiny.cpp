#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/math/union_find.h"
#include "evolve/groom/film_cutter.h"
#include "evolve/groom/pop.h"

namespace meniscus::groom {

namespace {

// How bound a vertex is: the looser end goes.
int bound_of(const FilmCutter& cut, const films::FilmComplex& complex, int v) {
  if (cut.is_loose(v)) {
    return 0;
  }
  return complex.vertices[v].kind == films::VertexKind::Free ? 1 : 2;
}

// Would a facet of `gone` be there twice?
bool doubles(const FilmCutter& cut, int gone, int kept) {
  std::map<Edge, int> opposite;
  for (const int end : {gone, kept}) {
    for (const int f : cut.star(end)) {
      Edge far{};
      int count = 0;
      for (const int v : cut.facet(f)) {
        if (v != gone && v != kept) {
          far[std::min(count, 1)] = v;
          ++count;
        }
      }
      if (count == 2 && ++opposite[edge_key(far[0], far[1])] > 1) {
        return true;
      }
    }
  }
  return false;
}

bool collapse(FilmCutter& cut, int a, int b) {
  films::FilmComplex& complex = cut.complex();
  const int bound_a = bound_of(cut, complex, a);
  const int bound_b = bound_of(cut, complex, b);
  const int kept = bound_a >= bound_b ? a : b;
  const int gone = kept == a ? b : a;
  // Only loose vertices go: marks, walls and curves keep theirs.
  if (std::min(bound_a, bound_b) > 0 || doubles(cut, gone, kept)) {
    return false;
  }
  const std::vector<int> along = cut.along(gone, kept);
  const auto frozen = [&](int f) { return !cut.is_liquid(f); };
  if (along.empty() || std::any_of(along.begin(), along.end(), frozen)) {
    return false;
  }
  if (bound_a == bound_b) {
    complex.mesh.points[kept] = 0.5 * (cut.points()[a] + cut.points()[b]);
  }
  for (const int f : along) {
    cut.remove(f);
  }
  for (const int f : std::vector<int>(cut.star(gone))) {
    cut.replace(f, gone, kept);
  }
  return true;
}

}  // namespace

int collapse_tiny_edges(films::FilmComplex& complex, double length) {
  if (!(std::isfinite(length) && length >= 0.0)) {
    throw InvalidInput(fmt::format(
        "edges shorter than {} are to go; must be 0 or more", length));
  }
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(complex.mesh.facets, edges, facet_edges);
  std::vector<std::tuple<double, int, int>> tiny;
  for (const auto& [a, b] : edges) {
    const double l = (complex.mesh.points[a] - complex.mesh.points[b]).norm();
    if (l < length) {
      tiny.emplace_back(l, a, b);
    }
  }
  std::sort(tiny.begin(), tiny.end());
  FilmCutter cut(complex);
  int count = 0;
  // Where a vertex went: later edges of the list follow it.
  UnionFind went(complex.mesh.points.size());
  for (const auto& [l, from, to] : tiny) {
    const int a = went.root(from);
    const int b = went.root(to);
    if (a != b && collapse(cut, a, b)) {
      const bool first = cut.star(a).empty();
      went.join_to(first ? b : a, first ? a : b);
      ++count;
    }
  }
  cut.tidy();
  return count;
}

}  // namespace meniscus::groom
