/// How the boundary curves carry the reference film to another design.
#pragma once

#include <optional>

#include "evolve/energy/energy.h"
#include "evolve/energy/laplacian.h"

namespace meniscus::frozen {

/// X(p) = X(p0) + C (r(p) - r(p0)): vertices on curves and rings move with
/// them (rim vertices here), every other vertex moves by a fixed mean of the
/// moves of the rim vertices, with rows of C that sum to one. On films C is
/// harmonic with positive weights (monotone: no vertex moves further than the
/// rims do); on a flat cap it is harmonic with exact cotangents, which
/// reproduces linear maps, so that the cap stays flat where its rim does.
/// Vertices on plane walls move within them: there C is harmonic in the
/// directions that walls leave. A face that films wet follows its rim, films'
/// and caps', to where that has slid, by follow(). Lines where films meet are
/// given like rims (evolve/frozen/line_lead.h has their moves), and the films
/// between follow both.
/// Immutable after construction; at() may run in several threads.
class Carry {
 public:
  /// `lines`: vertices of lines that are given like rims. `film_order`:
  /// films' vertices in a good order of elimination, FilmEnergy's. Throws
  /// MeshError for a film whose Laplacian is singular.
  Carry(const films::FilmComplex& reference, const std::vector<int>& lines,
        const std::vector<int>& film_order);

  /// Those of the lines that rims carry: of the others, on films that float,
  /// nothing is asked.
  const std::vector<int>& lines() const { return lines_; }

  /// A vertex that stands on a curve, by a share on each of two, or on the four
  /// points of a solid's frame: X_v = sum of weight x point_at(curve, t).
  struct Stand {
    int vertex = 0;
    double t = 0.0;
    double weight = 1.0;
  };
  /// Per curve, in the complex's order.
  const std::vector<std::vector<Stand>>& stands() const { return stands_; }

  /// Moves of the rim vertices from the reference to `curves` (same order as
  /// the complex's curves); zero at all other vertices.
  Points rim_moves(const std::vector<curves::Curve>& curves) const;

  /// X for `fraction` of the moves of rims and lines. The reference itself, bit
  /// for bit, when all moves are zero.
  Points at(const Points& rim_moves, double fraction) const;

  /// Puts the vertices inside faces that films wet where their rims, at
  /// `points`, have them: X, but from rims that have slid on walls. Throws
  /// MeshError, with the place, where a bent one has no nearest point.
  void follow(Points& points) const;

  /// follow() to `points` for rates of all vertices, and transposed: a gradient
  /// by the vertices that wetted faces follow, zero inside these.
  void follow_rates(const Points& points, Points& rates) const;
  void fold_caps(const Points& points, Points& by_points) const;

  /// How fast at(., 1) moves with the rates of the rims' and lines' vertices.
  Points rates(const Points& rim_rates) const;

  /// at() transposed at fraction 1: a gradient by the moves of the rims' and
  /// lines' vertices, zero at others, from one by all vertices.
  Points transpose(const Points& by_points) const;

  /// The same where lines are carried by the rims as films are, and not given.
  Points rates_over_lines(const Points& rim_rates) const;
  Points transpose_over_lines(const Points& by_points) const;

 private:
  struct Extension {
    std::vector<int> vertices;
    SparseMatrix outer;
    /// Where walls take directions away: from the coordinates that are left to
    /// the moves of all vertices, 3 a vertex; the factor is of those.
    SparseMatrix ways;
    std::optional<SymmetricFactor> factor;

    Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  };
  void add_stands_on_frame(const films::FilmComplex& reference, int vertex,
                           int frame);
  enum class Part { Films, Caps, Wetted };
  static int bent_face(const films::FilmComplex& reference, int facet);
  static bool is_apex(const films::FilmComplex& reference, int facet, int v);
  Points by_weights(const Points& points) const;
  static Part part_of(const films::ComplexSurface& surface);
  /// `given` (one per vertex): of lines, which are not carried.
  static std::vector<char> carried_vertices(const films::FilmComplex& reference,
                                            Part part,
                                            const std::vector<char>& given);
  static Extension extend(const films::FilmComplex& reference, Part part,
                          const std::vector<char>& given,
                          const std::vector<int>& order);
  static void bind_to_walls(const films::FilmComplex& reference,
                            const SparseMatrix& inner, Extension& extension);
  /// Adds to `moves` those of the extension's vertices.
  static void apply(const Extension& extension, Points& moves);
  static void add_transposed(const Extension& extension,
                             const Points& by_points, Points& result);
  Points rates_by(const Extension& films, const Points& rim_rates) const;
  Points transpose_by(const Extension& films, const Points& by_points) const;

  Points reference_;
  std::vector<std::vector<Stand>> stands_;
  std::vector<char> stands_on_curves_;  // per vertex
  std::vector<int> lines_;
  std::vector<char> given_;  // per vertex: on a curve or a line
  bool slides_ = false;      // on walls, some of it
  Extension films_;
  Extension over_lines_;  // films_ where there are lines, which it carries too
  Extension caps_;
  Extension wetted_;  // after both
  // Of its vertices those on bent walls, where they go to the nearest point.
  std::vector<std::pair<int, films::BentWall>> on_bent_;
};

}  // namespace meniscus::frozen
