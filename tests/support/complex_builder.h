/// Puts a film complex together piece by piece, for tests and benchmarks.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::test_films {

class ComplexBuilder {
 public:
  /// Each returns the index of what it adds.
  int liquid(const std::string& name, double tension = 1.0);
  int solid(const std::string& name);
  int curve(const std::string& name, curves::CurveShape shape);
  int vertex(const Vec3& place,
             films::VertexKind kind = films::VertexKind::Free);
  int on_curve(int curve, double t);

  void facet(int surface, int a, int b, int c);
  /// Two facets, cut along a-c.
  void quad(int surface, int a, int b, int c, int d);
  /// Four facets about a new vertex in the middle.
  void quad_about_centre(int surface, int a, int b, int c, int d);
  /// Facets from each piece of the closed `ring` to a new vertex in its
  /// middle; `ring` runs counter-clockwise about the facets' normal.
  void fan(int surface, const std::vector<int>& ring, films::VertexKind kind);

  /// A ring of `n` vertices of a curve at t = i / n + offset, its edges marked.
  std::vector<int> rim(int curve, int n, double offset = 0.0);
  /// A marked edge between fixed vertices.
  void fixed_edge(int a, int b);
  /// Quads between two rings of equal size, outward where `lower` runs
  /// counter-clockwise seen from `upper`.
  void band(int surface, const std::vector<int>& lower,
            const std::vector<int>& upper);

  /// The unit square of cells (i, j), 0 <= i, j < n, spanned by u and v from
  /// `origin`, each cut about its centre; vertices in the same place are one.
  /// Normals along u x v.
  void plate(int surface, const Vec3& origin, const Vec3& u, const Vec3& v,
             int n);

  const Vec3& place(int vertex) const { return complex_.mesh.points[vertex]; }
  films::FilmComplex& complex() { return complex_; }

 private:
  int corner(const Vec3& place);

  films::FilmComplex complex_;
  std::vector<int> corners_;  // vertices that plates share
};

}  // namespace meniscus::test_films
