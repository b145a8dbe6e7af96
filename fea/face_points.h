/// Quadrature on the boundary faces of a mesh.
#pragma once

#include <array>
#include <vector>

#include "core/tet_mesh.h"

namespace meniscus {

enum class FaceRule {
  Three,  // exact to degree 2; CalculiX's for C3D10
  Seven   // exact to degree 5 (Radon 1948)
};

/// One point of one face.
struct FacePoint {
  std::array<double, 6> shape{};  // shape functions of the face's nodes
  Vec3 position = Vec3::Zero();   // [length]
  Vec3 normal = Vec3::Zero();     // outward, its length the point's share of
                                  // the face's area [length^2]
};

class FaceQuadrature {
 public:
  /// `order`: the mesh's, 1 or 2.
  FaceQuadrature(int order, FaceRule rule);

  int size() const { return static_cast<int>(points_.size()); }
  FacePoint at(const TetMesh& mesh, int face, int point) const;

 private:
  struct Reference {
    double weight = 0.0;
    std::array<double, 6> shape{};
    std::array<std::array<double, 2>, 6> slope{};
  };
  std::vector<Reference> points_;
};

/// visit(face, point) for every point of every face of the label.
template <class Visit>
void over_face_points(const TetMesh& mesh, int label, FaceRule rule,
                      const Visit& visit) {
  const FaceQuadrature quadrature(mesh.order, rule);
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[f] == label) {
      for (int q = 0; q < quadrature.size(); ++q) {
        visit(f, quadrature.at(mesh, f, q));
      }
    }
  }
}

}  // namespace meniscus
