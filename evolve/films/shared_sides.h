/// Polygons that share sides: plane faces that meet along edges.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// A side of two polygons that both run between the same two corners.
struct SharedSide {
  int first_curve = 0;
  int first_side = 0;  // from corner first_side to the next
  int second_curve = 0;
  int second_side = 0;
  bool reversed = false;  // run in opposite directions
};

/// All of them, in order of the curves; corners may be 1e-9 x the polygons'
/// size apart. Curves of other kinds share none.
std::vector<SharedSide> shared_sides(const std::vector<curves::Curve>& curves);

/// Makes the rims of polygons with shared sides out of one set of vertices: a
/// corner is one vertex, a side one chain, for all polygons that have it. Each
/// belongs to the polygon that came first; marked edges say so to refinement
/// and grooming, which otherwise find rims by their curves.
class SharedRims {
 public:
  explicit SharedRims(const std::vector<curves::Curve>& curves);

  /// Has the curve a side that another one has too?
  bool shares(int curve) const {
    return shares_[static_cast<std::size_t>(curve)] != 0;
  }

  /// The vertices around such a polygon, cut into pieces at the parameters
  /// `t` (sample_parameters) where it is the first to have a side.
  std::vector<int> rim(int curve, const std::vector<double>& t,
                       FilmComplex& complex);

  /// Marks the edges of all rims made so far.
  void mark_edges(FilmComplex& complex) const;

 private:
  struct Chain {
    int curve = 0;          // whose vertices these are
    std::vector<int> from;  // smaller corner to larger one, ends included
  };
  int corner(int curve, int k, FilmComplex& complex);

  std::vector<char> shares_;
  double reach_ = 0.0;  // corners nearer than this are one [length]
  std::vector<int> corners_;
  std::map<Edge, Chain> sides_;
};

}  // namespace meniscus::films
