#include "fea/element/outer_edges.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace meniscus::element {

std::vector<OuterEdge> outer_edges(const TetMesh& mesh) {
  struct Uses {
    OuterEdge edge;
    std::size_t count = 0;
  };
  std::map<Edge, Uses> found;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (!mesh.face_front.empty() && mesh.face_front[f] >= 0) {
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] =
          std::minmax({mesh.face(f)[k], mesh.face(f)[(k + 1) % 3]});
      Uses& uses = found[{low, high}];
      uses.edge.corners = {low, high};
      if (uses.count < 2) {
        uses.edge.face[uses.count] = f;
        uses.edge.place[uses.count] = mesh.order == 2 ? 3 + k : k;
      }
      ++uses.count;
    }
  }
  std::vector<OuterEdge> edges;
  for (const auto& [corners, uses] : found) {
    if (uses.count == 2) {
      edges.push_back(uses.edge);
    }
  }
  return edges;
}

Turn turn_of(const TetMesh& mesh, const FaceQuadrature& at_nodes,
             const OuterEdge& edge) {
  const int k = edge.place[0] % 3;  // as the first face runs along the edge
  const auto nodes = mesh.face(edge.face[0]);
  const Vec3 along =
      (mesh.nodes[nodes[(k + 1) % 3]] - mesh.nodes[nodes[k]]).normalized();
  const Vec3 a = at_nodes.at(mesh, edge.face[0], edge.place[0]).normal;
  const Vec3 b = at_nodes.at(mesh, edge.face[1], edge.place[1]).normal;
  const double sine = a.cross(b).dot(along);
  const double cosine = a.dot(b);
  // Of -atan2(sine, cosine). The edge's direction has no part in it: both
  // normals are normal to it.
  const double scale = 1.0 / (sine * sine + cosine * cosine);
  return {-std::atan2(sine, cosine),
          {scale * (sine * b - cosine * b.cross(along)),
           scale * (sine * a - cosine * along.cross(a))}};
}

}  // namespace meniscus::element
