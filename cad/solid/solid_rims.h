/// Internal to film_solid: the rims of a solid, one for each boundary loop of
/// its faces, and which of their pieces are the same.
#pragma once

#include <deque>
#include <map>
#include <set>
#include <vector>

#include "cad/solid/curve_through.h"
#include "cad/solid/face_lines.h"
#include "cad/solid/film_solid.h"
#include "cad/solid/rim_edges.h"
#include "core/geometry/edge_key.h"

namespace meniscus::solid {

/// A face's boundary loop and the rim that it lies on.
struct SolidLoop {
  int rim = 0;
  std::vector<int> vertices;   // film on the left
  std::vector<double> places;  // of these, on the rim's curve
  bool growing = true;         // runs along growing places
};

class SolidRims {
 public:
  SolidRims(const SurfaceMesh& mesh, const std::vector<NamedRim>& rims);

  /// True for an edge of the mesh that lies on a line or arc that two named
  /// rims have: there a plane face ends, though the next one may have the same
  /// name.
  bool on_shared_side(const Edge& edge) const;
  /// An edge of the mesh where two plane faces of one name meet.
  void add_crease(const Edge& edge) { creases_.insert(edge); }

  /// The facets of each face, of all of the mesh; before any loop.
  void set_faces(const std::vector<std::vector<int>>& faces);
  /// A loop along one closed line lies on the named rim that the line lies on,
  /// or on the line's own curve, which is a polygon beside a face that ends at
  /// creases, else a spline; the faces on both sides have that rim. A loop of
  /// several lines has a rim of its own, whose pieces are the lines'.
  SolidLoop loop_of(const std::vector<int>& loop);
  const RimCurve& curve(int rim) const { return curves_[rim]; }
  /// All rims, not built yet; the pieces of `used` are shared among them, each
  /// by the first that has it.
  std::vector<RimEdges> edges(const std::set<int>& used) const;
  /// Corners nearer than this are one [length].
  double same() const { return same_; }

 private:
  struct Side {  // a line or an arc of a named rim
    RimPiece shape;
    Vec3 from;
    Vec3 to;
    int rim = 0;
  };
  struct Named {  // vertices of the mesh on a named rim
    std::map<int, double> places;
    std::vector<int> order;  // along it
  };
  struct Source {  // which piece of a line a rim's piece is
    int line = 0;
    int piece = 0;
    bool reversed = false;
  };

  void add_named(const std::vector<NamedRim>& rims);
  std::vector<Side> sides_of(int rim) const;
  bool alike(const Side& a, const Side& b) const;
  bool lies_on(const Side& side, const Vec3& p) const;
  bool has_next(const Named& named, int v, int w) const;
  int named_rim_of(const FaceLine& line) const;
  bool ends_at_crease(const FaceLine& line) const;
  PointCurve polygon_through(const Points& points, bool closed) const;
  PointCurve named_part(int rim, const FaceLine& line) const;
  const PointCurve& curve_of(int line);
  SolidLoop closed_loop(const std::vector<int>& loop, const LineRun& run);
  SolidLoop composed_loop(const std::vector<int>& loop,
                          const std::vector<LineRun>& runs);

  const SurfaceMesh& mesh_;
  double same_ = 0.0;
  std::deque<RimCurve> curves_;  // addresses stay; the named ones first
  std::vector<Named> named_;
  std::vector<Side> sides_;   // of the rims that were given
  std::vector<Side> shared_;  // of these, each as often as rims have it
  std::set<Edge> creases_;
  FaceLines lines_;
  std::map<int, PointCurve> line_curves_;
  std::map<int, int> rim_of_line_;               // closed lines
  std::map<int, std::vector<Source>> composed_;  // of a rim's pieces
};

}  // namespace meniscus::solid
