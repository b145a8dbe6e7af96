/// Edits a triangle complex in place: splits, collapses, flips and vertex
/// averaging that never change the topology. Frozen facets, held vertices and
/// border edges (rims, triple lines, edges to another surface) stay as they
/// are. Everything runs in a fixed order, so equal input gives equal bits.
#pragma once

#include <vector>

#include "core/surface_mesh.h"

namespace meniscus {

/// What must not be touched. All lists may be empty, meaning none.
struct EditLimits {
  std::vector<char> held;     // per point: does not move and is not removed
  std::vector<char> frozen;   // per facet: is not changed
  std::vector<int> rim_next;  // per point: next point on its rim, or -1;
                              // such edges are borders whatever joins there
};

class SurfaceEditor {
 public:
  SurfaceEditor(SurfaceMesh mesh, EditLimits limits);

  /// Halves free edges longer than `length`, the longest first.
  void split_above(double length);

  /// Removes free edges shorter than `length`, the shortest first, where no
  /// new edge gets longer than `longest` and no facet turns or degenerates.
  void collapse_below(double length, double longest);

  /// Flips free edges where that increases the smaller of the smallest angles
  /// of the two facets, and does not fold the surface. Returns the number.
  int flip_all();

  /// Moves each free vertex along the surface to the area-weighted centre of
  /// its facets, less where a facet would turn over.
  void average();

  /// The result: points that are still used, survivors first in their old
  /// order. `origin` (if asked for): per point its old number, or -1.
  SurfaceMesh finish(std::vector<int>* origin = nullptr) const;

 private:
  struct Pair {  // the two facets along an edge and the corners off it
    int left = -1, right = -1, left_corner = -1, right_corner = -1;
  };

  bool alive(int facet) const { return mesh_.facets[facet][0] >= 0; }
  bool has_edge(int a, int b) const;
  bool is_rim(int a, int b) const;
  bool free_pair(int a, int b, Pair& pair) const;
  void hold_border_vertices();
  void replace_corner(int facet, int from, int to);
  void drop_from_star(int vertex, int facet);
  int add_facet(const Triangle& corners, int label);
  int split(int a, int b, const Pair& pair);
  bool can_collapse(int gone, int kept, const Vec3& place,
                    double longest) const;
  bool link_allows(int gone, int kept, const Pair& pair) const;
  void collapse(int gone, int kept, const Vec3& place, const Pair& pair);
  bool should_flip(int a, int b, const Pair& pair) const;
  void flip(int a, int b, const Pair& pair);
  Vec3 normal2(int facet) const { return area_vector2(mesh_, facet); }
  double length(int a, int b) const {
    return (mesh_.points[b] - mesh_.points[a]).norm();
  }
  template <typename Visit>
  void for_each_edge(const Visit& visit) const;

  SurfaceMesh mesh_;
  EditLimits limits_;
  std::vector<std::vector<int>> star_;  // per point: its facets
  int old_points_ = 0;
};

/// Passes of split, collapse, flip and average towards triangles of `edge`.
void make_isotropic(SurfaceEditor& editor, double edge, int passes);

/// Smallest angle of a triangle [rad]; 0 when degenerate.
double smallest_angle(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace meniscus
