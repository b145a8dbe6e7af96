/// The marked edges of a complex, rims that are known by their vertices only
/// included, and what is born in the middle of such an edge.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// Built once, asked often. Refers to nothing.
class EdgeMarks {
 public:
  explicit EdgeMarks(const FilmComplex& complex);

  /// The marked edges of the complex with their indices, then those of rims
  /// that are not marked (rim_neighbours), as OnCurve.
  const std::vector<ComplexEdge>& all() const { return all_; }

  /// Index into all() of the edge between two points; -1: not marked, as are
  /// the edges of points that came later.
  int find(int a, int b) const {
    return touched(a) && touched(b) ? search(a, b) : -1;
  }

 private:
  int search(int a, int b) const;
  bool touched(int v) const {
    return v < static_cast<int>(touched_.size()) && touched_[v] != 0;
  }

  std::vector<ComplexEdge> all_;
  std::vector<int> sorted_;    // indices of all_ by (smaller, larger) point
  std::vector<char> touched_;  // per point: on a marked edge
};

struct PlacedVertex {
  ComplexVertex vertex;
  Vec3 place;
};

/// The vertex born in the middle of marked edge `mark` between a and b: on
/// curves at the middle parameter (of an end that is not on the curve: at the
/// nearest point), on bands halfway, on edges of solids at the point next to
/// the middle, on walls at the point of the level sets next to the middle.
PlacedVertex born_on(const FilmComplex& complex, const ComplexEdge& mark,
                     const PlacedVertex& a, const PlacedVertex& b);

/// Where on a band a vertex stands that is inside its ring or on its curves.
BandPlace place_on_band(const FilmComplex& complex, int band,
                        const PlacedVertex& at);

/// The vertex born in a ring, halfway between a and b of its band: inside it,
/// or on its curves.
PlacedVertex born_on_band(const FilmComplex& complex, int band,
                          const PlacedVertex& a, const PlacedVertex& b);

/// The vertex born inside a solid's face, next to the middle of a and b.
PlacedVertex born_on_face(const FilmComplex& complex, int face,
                          const PlacedVertex& a, const PlacedVertex& b);

/// The point of the level sets of a constraint set next to `at`, by Newton's
/// least steps with exact gradients. `held` false: one-sided ones count only
/// where they are violated. Stays where it is when the gradients vanish.
Vec3 onto_walls(const FilmComplex& complex, int set, bool held, const Vec3& at);

/// Parameter of the curve's point nearest to `at`; parametric curves are
/// searched from `near`, closed ones all around.
double nearest_parameter(const curves::CurveShape& shape, const Vec3& at,
                         double near);

}  // namespace meniscus::films
