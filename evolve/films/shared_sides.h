/// Polygons and polylines that share sides: faces that meet along edges.
#pragma once

#include <map>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// A straight side or an arc between two corners of a curve.
struct CurveSide {
  Vec3 from;
  Vec3 to;
  Vec3 middle;  // half its length away from either
};

/// Of polygons and polylines; others have none.
std::vector<CurveSide> sides_of(const curves::CurveShape& shape);

/// A side of two curves that both run between the same two corners, the same
/// way.
struct SharedSide {
  int first_curve = 0;
  int first_side = 0;  // from corner first_side to the next
  int second_curve = 0;
  int second_side = 0;
  bool reversed = false;  // run in opposite directions
};

/// All of them, in order of the curves; corners and middles may be 1e-9 x the
/// curves' size apart.
std::vector<SharedSide> shared_sides(const std::vector<curves::Curve>& curves);

/// Where curves hold nothing. A side is free where all curves that have it say
/// so, a corner where all sides are that meet there.
class FreePlaces {
 public:
  /// `used`: one per curve, of those that some surface ends at.
  FreePlaces(const std::vector<curves::Curve>& curves,
             const std::vector<char>& used);

  bool is_side_free(int curve, int side) const {
    return sides_[static_cast<std::size_t>(curve)]
                 [static_cast<std::size_t>(side)] != 0;
  }
  /// At a place of the curve, t from 0 to 1.
  bool is_free(int curve, double t) const;

 private:
  bool any_ = false;
  std::vector<char> whole_;               // per curve, of those without sides
  std::vector<std::vector<char>> sides_;  // per curve
  std::vector<std::vector<char>> corners_;
};

/// Makes the rims of curves with shared sides out of one set of vertices: a
/// corner is one vertex, a side one chain, for all curves that have it. Each
/// belongs to the curve that came first; marked edges say so to refinement
/// and grooming, which otherwise find rims by their curves.
class SharedRims {
 public:
  explicit SharedRims(const std::vector<curves::Curve>& curves);

  /// Has the curve a side that another one has too?
  bool shares(int curve) const {
    return shares_[static_cast<std::size_t>(curve)] != 0;
  }

  /// The vertices around such a curve, cut into pieces at the parameters
  /// `t` (sample_parameters) where it is the first to have a side.
  std::vector<int> rim(int curve, const std::vector<double>& t,
                       FilmComplex& complex);

  /// Marks the edges of all rims made so far but for free sides.
  void mark_edges(const FreePlaces& free, FilmComplex& complex) const;

 private:
  struct Chain {
    int curve = 0;  // whose vertices these are
    int side = 0;   // of that curve
    Vec3 middle;
    std::vector<int> from;  // smaller corner to larger one, ends included
  };
  int corner(int curve, int k, const CurveSide& side, int sides,
             FilmComplex& complex);
  const Chain& chain(int curve, int number, const CurveSide& side,
                     const Edge& ends, const std::vector<double>& inner,
                     FilmComplex& complex);

  std::vector<char> shares_;
  double reach_ = 0.0;  // corners nearer than this are one [length]
  std::vector<int> corners_;
  std::map<Edge, std::vector<Chain>> sides_;  // by corners, smaller first
};

}  // namespace meniscus::films
