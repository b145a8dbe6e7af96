/// Edits a film complex in place, manifold or not: splits, collapses, flips
/// and vertex averaging that never change the topology.
///
/// Lines are the edges that are not inside one film: triple lines, borders
/// between surfaces, marked edges, rims. A line that is liquid is split,
/// collapsed and averaged along itself only: its vertices stay on it, its
/// films and marks stay with it. Held: vertices that are not liquid, on solid
/// or unrefined facets, on rims, open or unrefined edges; ends and meetings of
/// lines; points where sheets touch. Vertices with constraints stay on their
/// level sets, sliding ones on their curves. Collapses keep the link condition
/// of complexes with strata (Dey, Edelsbrunner, Guha, Nekhayev 1999).
/// Everything runs in a fixed order, so equal input gives equal bits.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "evolve/films/edge_marks.h"
#include "evolve/films/film_complex.h"
#include "evolve/films/triangle_shape.h"
#include "evolve/groom/flip_average.h"

namespace meniscus::groom {

/// The edge length wanted, [length], > 0: `field` at a place, or `edge`.
struct EdgeTarget {
  double edge = 1.0;
  std::function<double(const Vec3&)> field;
  /// Throws InvalidInput when the field gives no positive number.
  double at(const Vec3& place) const { return field ? field_at(place) : edge; }

 private:
  double field_at(const Vec3& place) const;
};

class SurfaceEditor {
 public:
  explicit SurfaceEditor(films::FilmComplex complex);

  /// The longest edge that may be changed, x target.
  double longest(const EdgeTarget& target) const;

  /// Facets with edges of the target's length that the films take, by the area
  /// and the longest edge of each of today's.
  double expected_facets(const EdgeTarget& target) const;
  /// So many that grooming has gone astray. Throws InvalidInput where memory
  /// does not hold what is expected.
  double most_facets(const EdgeTarget& target) const;

  /// Halves edges longer than `factor` x target, the longest first. Throws
  /// InvalidInput where that leaves far more facets than are expected, or more
  /// than memory holds.
  void split_above(double factor, const EdgeTarget& target);

  /// Removes edges shorter than `factor` x target, the shortest first, where
  /// no new edge gets longer than `longest` x target and no facet turns or
  /// degenerates.
  void collapse_below(double factor, double longest, const EdgeTarget& target);

  /// Flips edges inside films where that increases the smaller of the smallest
  /// angles of the two facets, and as `rule` says. Returns the number.
  int flip_all(FlipRule rule = FlipRule::KeepShape);

  /// Moves each liquid vertex along its film to the centre of its facets
  /// (weights: area over target^2), on lines along the line to the middle of
  /// its neighbours; less where a facet would turn over. `marked`: by point,
  /// the only ones that move; empty: all.
  void average(const EdgeTarget& target, const std::vector<char>& marked = {});

  /// The result: points that are still used, survivors first in their old
  /// order; marks likewise.
  films::FilmComplex finish() &&;

 private:
  // An edge collapses into the end of higher rank.
  enum class Rank : char { Film, Wall, Line, Held };
  struct LineEnd {
    int to;
    int mark;  // index into marks_, or -1
    bool moves;
  };
  struct Wing {  // a facet along an edge and its corner off it
    int facet;
    int corner;
  };

  /// Of the edge gathered last, a to b, halved at `made`: the longest side of a
  /// facet in which the new edge would be no shorter than it.
  std::optional<std::pair<int, int>> longer_side(int a, int b,
                                                 const Vec3& made) const;
  void find_lines();
  void rank_vertices();
  Rank rank_of(int v) const;
  bool same_line(int v) const;
  bool link_is_connected(int v) const;
  std::vector<int> labels_along(int a, int b) const;

  bool alive(int facet) const { return mesh_.facets[facet][0] >= 0; }
  bool has_edge(int a, int b) const;
  bool has_facet(int a, int b, int c) const;
  const LineEnd* line(int a, int b) const;
  LineEnd& line_end(int from, int to);
  bool gather(int a, int b);
  films::PlacedVertex placed(int v) const {
    return {complex_.vertices[v], mesh_.points[v]};
  }
  films::PlacedVertex middle(int a, int b, const LineEnd* line) const;
  void replace_corner(int facet, int from, int to);
  void drop_from_star(int vertex, int facet);
  void add_facet(const Triangle& corners, int label);
  int add_vertex(const films::PlacedVertex& made, Rank rank);

  void split(int a, int b, const films::PlacedVertex& made);
  bool try_collapse(int a, int b, double longest, const EdgeTarget& target,
                    int& kept);
  bool can_collapse(int gone, int kept, const Vec3& place, double longest,
                    const EdgeTarget& target) const;
  bool link_allows(int gone, int kept) const;
  void collapse(int gone, int kept, const films::PlacedVertex& place);
  void move_lines(int gone, int kept);

  bool should_flip(int a, int b, int c, int d, FlipRule rule) const;
  void flip(int a, int b, int left, int right, int c, int d);

  Vec3 film_move(int v, const EdgeTarget& target, Vec3& normal) const;
  Vec3 line_move(int v, const EdgeTarget& target) const;
  films::PlacedVertex moved(int v, const Vec3& move) const;
  double worst_shape(int v, const std::vector<Vec3>& normals) const;

  Vec3 normal2(int facet) const { return area_vector2(mesh_, facet); }
  double ratio(int a, int b, const EdgeTarget& target) const;
  template <typename Visit>
  void for_each_edge(const Visit& visit) const;

  films::FilmComplex complex_;  // without its mesh, which is:
  SurfaceMesh mesh_;
  std::vector<films::ComplexEdge> marks_;  // those of the complex, then of
                                           // rims, then born ones; a = -1: gone
  std::size_t old_marks_ = 0;
  std::size_t old_and_rim_marks_ = 0;
  std::vector<char> frozen_;                 // per facet: is not changed
  std::vector<char> changed_;                // per point: since the last flips
  std::vector<Rank> rank_;                   // per point
  std::vector<std::vector<LineEnd>> lines_;  // per point
  std::vector<std::vector<int>> star_;       // per point: its facets
  std::vector<Wing> wings_;                  // of the edge gathered last
};

/// Passes of split, collapse, flip and average towards triangles of `target`.
/// Edges much longer are first cut down by halves.
void make_isotropic(SurfaceEditor& editor, const EdgeTarget& target,
                    int passes);

}  // namespace meniscus::groom
