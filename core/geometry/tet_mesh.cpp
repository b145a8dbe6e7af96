#include "core/geometry/tet_mesh.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace meniscus {

int TetMesh::label_of(const std::string& name) const {
  const auto found = std::find(labels.begin(), labels.end(), name);
  return found == labels.end() ? -1 : static_cast<int>(found - labels.begin());
}

double corner_volume(const TetMesh& mesh, int element) {
  const auto ids = mesh.element(element);
  const Vec3& a = mesh.nodes[ids[0]];
  const Vec3 u = mesh.nodes[ids[1]] - a;
  const Vec3 v = mesh.nodes[ids[2]] - a;
  const Vec3 w = mesh.nodes[ids[3]] - a;
  return u.cross(v).dot(w) / 6.0;
}

}  // namespace meniscus
