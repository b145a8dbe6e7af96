#include "fea/shell/rigid_rims.h"

#include <Eigen/Geometry>

namespace meniscus::shell {

ShellMesh on_seats(const ShellMesh& mesh, const ShellFreedom& freedom) {
  ShellMesh result;
  result.nodes = mesh.nodes;
  for (const RigidRim& rim : freedom.rims()) {
    result.nodes.push_back(rim.point);
  }
  result.facets = mesh.facets;
  for (std::array<int, 6>& facet : result.facets) {
    for (int& node : facet) {
      node = freedom.seat(node);
    }
  }
  return result;
}

FacetMatrix on_seats(const ShellFreedom& freedom,
                     const std::array<int, 6>& facet, const FacetMatrix& K) {
  FacetMatrix result = K;
  for (int i = 0; i < kNodes; ++i) {
    if (freedom.seat(facet[i]) == facet[i]) {
      continue;
    }
    const Matrix6 T = freedom.by_seat(facet[i]);
    result.middleRows<6>(6 * i) =
        (T.transpose() * result.middleRows<6>(6 * i)).eval();
    result.middleCols<6>(6 * i) = (result.middleCols<6>(6 * i) * T).eval();
  }
  return result;
}

namespace {

/// By the point, of what one of its nodes does.
Vec3 by_arm(const RimPair& pair, int node) {
  const auto force = [node](const VectorX& all) -> Vec3 {
    return all.segment<3>(6L * node);
  };
  const auto turn = [node](const VectorX& all) -> Vec3 {
    return all.segment<3>(6L * node + 3);
  };
  return force(pair.adjoint_residual).cross(turn(pair.u)) +
         force(pair.residual).cross(turn(pair.v));
}

}  // namespace

void add_rim_gradient(const std::vector<RigidRim>& rims, const RimPair& pair,
                      Points& by_nodes) {
  for (const RigidRim& rim : rims) {
    for (const int node : rim.nodes) {
      by_nodes[node] -= by_arm(pair, node);
    }
  }
}

Vec3 by_rim_point(const RigidRim& rim, const RimPair& pair) {
  Vec3 sum = Vec3::Zero();
  for (const int node : rim.nodes) {
    sum += by_arm(pair, node);
  }
  return sum;
}

}  // namespace meniscus::shell
