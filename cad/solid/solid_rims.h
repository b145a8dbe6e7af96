/// Internal to film_solid: the rims of a solid. Which rim a loop of the mesh
/// lies on, and which sides plane faces have in common.
#pragma once

#include <deque>
#include <set>
#include <vector>

#include "cad/solid/film_solid.h"
#include "cad/solid/rim_edges.h"
#include "core/geometry/edge_key.h"

namespace meniscus::solid {

class SolidRims {
 public:
  /// Two rims share a side where lines or circular arcs of both are the same.
  SolidRims(const SurfaceMesh& mesh, const std::vector<NamedRim>& rims);

  /// The curve that a loop lies on; a new one where there is none: a polygon
  /// around a face that ends at creases, else a spline.
  int rim_of(const std::vector<int>& loop);
  const RimCurve& curve(int rim) const { return curves_[rim]; }
  /// True for an edge of the mesh that lies on a side that rims share: there a
  /// plane face ends, though the next one may have the same name.
  bool on_shared_side(const Edge& edge) const;
  /// An edge of the mesh where two plane faces of one name meet.
  void add_crease(const Edge& edge) { creases_.insert(edge); }
  /// All rims, not built yet; the sides of `used` are shared among them, each
  /// by the first that has it.
  std::vector<RimEdges> edges(const std::set<int>& used) const;
  /// Corners nearer than this are one [length].
  double same() const { return same_; }

 private:
  struct Side {
    RimPiece shape;
    Vec3 from;
    Vec3 to;
    int rim = 0;
    int piece = 0;
  };
  std::vector<Side> sides_of(int rim) const;
  bool alike(const Side& a, const Side& b) const;
  bool lies_on(const Side& side, const Vec3& p) const;
  bool ends_at_creases(const std::vector<int>& loop) const;
  RimCurve polygon_around(const Points& points) const;

  const SurfaceMesh& mesh_;
  double same_ = 0.0;
  std::deque<RimCurve> curves_;  // addresses stay
  std::vector<std::set<int>> members_;
  std::vector<Side> sides_;   // of the rims that were given
  std::vector<Side> shared_;  // of these, each as often as rims have it
  std::set<Edge> creases_;
};

}  // namespace meniscus::solid
