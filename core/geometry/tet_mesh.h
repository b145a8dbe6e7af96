/// Tetrahedral meshes as plain arrays.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/types.h"

namespace meniscus {

/// Four-node (order 1) or ten-node (order 2) tetrahedra. Node order of an
/// element is VTK's and CalculiX's: corners 0..3 with positive volume
/// (det[x1-x0, x2-x0, x3-x0] > 0), then mid-sides (01) (12) (02) (03) (13)
/// (23). Boundary faces are outward: corners counter-clockwise from outside,
/// then, for order 2, mid-sides (01) (12) (20). Where two bodies meet, their
/// interface is a face too, outward from the body of face_element.
///
/// Nodes of the surface mesh that was filled come first, with their numbers;
/// for order 2, corners come before mid-sides.
struct TetMesh {
  int order = 1;
  Points nodes;                     // [length]
  int corner_count = 0;             // nodes [0, corner_count) are corners
  std::vector<int> elements;        // nodes_per_element() ids each
  std::vector<int> element_region;  // one per element: body number, from 0
  std::vector<int> faces;           // nodes_per_face() ids each
  std::vector<int> face_label;      // one per face: index into labels
  std::vector<int> face_element;    // one per face: the element behind it
  std::vector<int> face_front;      // one per face: the element in front where
                                    // two bodies meet, else -1; may be empty
  std::vector<std::string> labels;  // surface names

  int nodes_per_element() const { return order == 1 ? 4 : 10; }
  int nodes_per_face() const { return order == 1 ? 3 : 6; }
  int element_count() const {
    return static_cast<int>(elements.size()) / nodes_per_element();
  }
  int face_count() const {
    return static_cast<int>(faces.size()) / nodes_per_face();
  }
  std::span<const int> element(int e) const {
    return {elements.data() + static_cast<std::size_t>(e) * nodes_per_element(),
            static_cast<std::size_t>(nodes_per_element())};
  }
  std::span<const int> face(int f) const {
    return {faces.data() + static_cast<std::size_t>(f) * nodes_per_face(),
            static_cast<std::size_t>(nodes_per_face())};
  }
  /// Index of `name` in labels, or -1.
  int label_of(const std::string& name) const;
};

/// Local corner pairs of the six mid-side nodes, in node order.
inline constexpr std::array<Edge, 6> kTetEdges = {
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// Signed volume of the straight-sided element through the corners [length^3].
double corner_volume(const TetMesh& mesh, int element);

}  // namespace meniscus
