/// Four-node tetrahedra that can be exchanged for others of the same cavity.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "mesh_tet/tet_quality.h"

namespace meniscus::mesh_tet {

/// Squared sine of the dihedral angle farthest from 90 degrees, from 0 to 8/9:
/// small for needle angles and for angles near 180 degrees alike. Below -1 for
/// elements without positive volume.
double tet_merit(const TetCorners& x);

using TetNodes = std::array<int, 4>;  // of positive volume

/// Works on a mesh of order 1 that is not touched by others meanwhile. Nodes
/// below `fixed` stay, and so do the mesh's faces.
class TetEditor {
 public:
  TetEditor(TetMesh& mesh, int fixed);

  int element_count() const { return static_cast<int>(merit_.size()); }
  bool alive(int e) const { return alive_[e] != 0; }
  double merit(int e) const { return merit_[e]; }
  TetNodes nodes(int e) const;
  const Vec3& point(int node) const { return mesh_.nodes[node]; }
  bool is_fixed(int node) const { return node < fixed_; }
  std::span<const int> star(int node) const { return star_[node]; }
  double star_merit(int node) const;

  /// Of the elements at `node` if it were at `place`; stops at the first that
  /// is not above `floor` and returns its merit.
  double star_merit_at(int node, const Vec3& place, double floor) const;
  void move(int node, const Vec3& place);

  double merit_of(const TetNodes& nodes) const;

  /// Merits computed so far: what the work costs, the same on every machine.
  std::int64_t evaluations() const { return evaluations_; }

  /// The elements around an inner edge, and the nodes of the ring, in right-
  /// handed order about a -> b, the first not repeated; nothing when the edge
  /// belongs to the surface.
  struct Ring {
    std::vector<int> elements;
    std::vector<int> nodes;
    double merit = 0.0;
  };
  std::optional<Ring> ring(int a, int b) const;

  /// Whether some element has all of these nodes. An exchange that makes an
  /// edge or face anew where elements have it already, as those may that lie
  /// over each other, would hang together what does not.
  bool has(std::span<const int> nodes) const;

  /// The element on the other side of the face opposite to `corner` of `e`;
  /// -1 where that is the surface.
  int neighbour(int e, int corner) const;

  int add_node(const Vec3& place);
  void drop_last_node();  // which no element has

  /// Exchanges elements of one region that fill the same cavity.
  void replace(std::span<const int> old, std::span<const TetNodes> fresh);

  /// Writes elements and regions back, those that died left out.
  void finish();

 private:
  bool is_surface_edge(int a, int b) const;
  bool is_surface_face(std::array<int, 3> face) const;
  TetCorners corners(const TetNodes& nodes) const;
  void put(int e, const TetNodes& nodes);

  TetMesh& mesh_;
  int fixed_;
  mutable std::int64_t evaluations_ = 0;
  /// Which of a star fell short last: it will most often be the next to do so.
  mutable std::size_t last_short_ = 0;
  std::vector<double> merit_;
  std::vector<char> alive_;
  std::vector<std::vector<int>> star_;
  std::vector<Edge> surface_edges_;                // sorted
  std::vector<std::array<int, 3>> surface_faces_;  // sorted, corners too
};

}  // namespace meniscus::mesh_tet
