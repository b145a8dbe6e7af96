/// A film complex with its stars at hand, for the operations that do change
/// the topology (evolve/groom/pop.h).
#pragma once

#include <vector>

#include "evolve/films/edge_marks.h"
#include "evolve/films/film_complex.h"

namespace meniscus::groom {

class FilmCutter {
 public:
  explicit FilmCutter(films::FilmComplex& complex);

  films::FilmComplex& complex() { return complex_; }
  const Points& points() const { return complex_.mesh.points; }
  const Triangle& facet(int f) const { return complex_.mesh.facets[f]; }
  int label(int f) const { return complex_.mesh.facet_label[f]; }
  const std::vector<int>& star(int v) const { return star_[v]; }
  std::vector<int> neighbours(int v) const;    // ascending
  std::vector<int> along(int a, int b) const;  // facets of an edge
  int corner_off(int f, int a, int b) const;
  bool is_liquid(int f) const {  // and may be changed
    const films::ComplexSurface& surface = complex_.surfaces[label(f)];
    return surface.liquid && surface.refine;
  }
  /// True when the vertex is liquid, free of walls and marked edges, and on
  /// liquid facets that may be changed.
  bool is_loose(int v) const;
  bool is_marked(int a, int b) const { return marks_.find(a, b) >= 0; }

  /// Body on the side of a facet that its normal points to, or the other; -1:
  /// none.
  enum class Side { Ahead, Behind };
  int body_at(int f, Side side) const;

  int add_vertex(const Vec3& place);
  void add_facet(const Triangle& corners, int label);
  void replace(int f, int from, int to);
  void remove(int f);

  /// A liquid surface like `like`, with a body on each side (-1: none).
  int add_surface(int like, int ahead, int behind);

  /// Drops removed facets, marks without a length, and the points that
  /// nothing uses any more. Ends the cutter's use.
  void tidy();

 private:
  films::FilmComplex& complex_;
  films::EdgeMarks marks_;
  std::vector<std::vector<int>> star_;
  std::vector<char> on_mark_;
};

}  // namespace meniscus::groom
