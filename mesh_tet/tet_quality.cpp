#include "mesh_tet/tet_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace meniscus {

namespace {

constexpr double kDegree = 180.0 / std::numbers::pi;

/// The two faces (as kTetFaces) that meet at each edge of kTetEdges: those
/// opposite to the other two corners.
constexpr std::array<Edge, 6> kFacesAtEdge = {
    {{2, 3}, {0, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}}};

std::array<Vec3, 4> face_normals2(const TetCorners& x) {
  std::array<Vec3, 4> normals;
  for (int f = 0; f < 4; ++f) {
    const auto& c = kTetFaces[f];
    normals[f] = (x[c[1]] - x[c[0]]).cross(x[c[2]] - x[c[0]]);
  }
  return normals;
}

double circumradius(const TetCorners& x, double volume) {
  const Vec3 a = x[1] - x[0];
  const Vec3 b = x[2] - x[0];
  const Vec3 c = x[3] - x[0];
  return (a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) +
          c.squaredNorm() * a.cross(b))
             .norm() /
         (12.0 * std::abs(volume));
}

}  // namespace

double tet_volume(const TetCorners& x) {
  return (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6.0;
}

std::array<double, 6> dihedral_cosines(const TetCorners& x) {
  const auto normals = face_normals2(x);
  std::array<double, 6> cosines;
  for (int e = 0; e < 6; ++e) {
    const Vec3& n = normals[kFacesAtEdge[e][0]];
    const Vec3& m = normals[kFacesAtEdge[e][1]];
    const double norms = n.norm() * m.norm();
    cosines[e] = norms > 0.0 ? std::clamp(-n.dot(m) / norms, -1.0, 1.0) : 1.0;
  }
  return cosines;
}

TetQuality tet_quality(const TetMesh& mesh) {
  TetQuality quality;
  if (mesh.element_count() == 0) {
    return quality;
  }
  double largest = -1.0;  // cosine
  double smallest = 1.0;
  quality.min_volume = std::numeric_limits<double>::infinity();
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    const TetCorners x = {mesh.nodes[ids[0]], mesh.nodes[ids[1]],
                          mesh.nodes[ids[2]], mesh.nodes[ids[3]]};
    for (const double c : dihedral_cosines(x)) {
      if (c > largest) {
        largest = c;
        quality.worst_element = e;
      }
      smallest = std::min(smallest, c);
    }
    const double volume = tet_volume(x);
    double longest = 0.0;
    double shortest = std::numeric_limits<double>::infinity();
    for (const Edge& edge : kTetEdges) {
      const double length = (x[edge[1]] - x[edge[0]]).norm();
      longest = std::max(longest, length);
      shortest = std::min(shortest, length);
    }
    double area = 0.0;
    for (const Vec3& n : face_normals2(x)) {
      area = std::max(area, 0.5 * n.norm());
    }
    quality.max_aspect =
        std::max(quality.max_aspect, longest * area / (3.0 * std::abs(volume)));
    quality.max_radius_edge =
        std::max(quality.max_radius_edge, circumradius(x, volume) / shortest);
    quality.min_volume = std::min(quality.min_volume, volume);
  }
  quality.min_dihedral_deg = kDegree * std::acos(largest);
  quality.max_dihedral_deg = kDegree * std::acos(smallest);
  return quality;
}

}  // namespace meniscus
