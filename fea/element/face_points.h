/// Quadrature on the boundary faces of a mesh.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/tet_mesh.h"

namespace meniscus::element {

enum class FaceRule {
  Three,  // exact to degree 2; CalculiX's for C3D10
  Seven,  // exact to degree 5 (Radon 1948)
  Nodes   // at the face's nodes, in their order, for the normals there; each
          // with the whole of the area
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
  /// `order`: the mesh's; 1 also for the corners' plane faces of a ten-node
  /// mesh, where shape functions of mid-sides are 0.
  FaceQuadrature(int order, FaceRule rule);

  int size() const { return static_cast<int>(points_.size()); }
  FacePoint at(const TetMesh& mesh, int face, int point) const;

  /// The transposed derivative of at(): adds to `gradient` (one per node of
  /// the mesh) what derivatives by the point's position and normal become by
  /// the positions of the face's nodes.
  void pull_back(const TetMesh& mesh, int face, int point,
                 const Vec3& by_position, const Vec3& by_normal,
                 Points& gradient) const;

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

/// What a sum over face points changes by.
struct FacePointGradient {
  Vec3 by_position = Vec3::Zero();
  Vec3 by_normal = Vec3::Zero();
};

/// Adds the pull-back of work(face, point), a FacePointGradient, for every
/// point of every face of the label.
template <class Work>
void pull_back_faces(const TetMesh& mesh, int label, FaceRule rule,
                     const Work& work, Points& gradient) {
  const FaceQuadrature quadrature(mesh.order, rule);
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[f] == label) {
      for (int q = 0; q < quadrature.size(); ++q) {
        const FacePointGradient g = work(f, quadrature.at(mesh, f, q));
        quadrature.pull_back(mesh, f, q, g.by_position, g.by_normal, gradient);
      }
    }
  }
}

/// Value at a face point of a field of 3 numbers per node.
inline Vec3 value_at(const TetMesh& mesh, int face, const FacePoint& point,
                     const VectorX& field) {
  Vec3 value = Vec3::Zero();
  const auto ids = mesh.face(face);
  for (std::size_t a = 0; a < ids.size(); ++a) {
    value += point.shape[a] * field.segment<3>(3L * ids[a]);
  }
  return value;
}

}  // namespace meniscus::element
