#include "fea/loads/remote_load.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"

namespace meniscus::loads {

namespace {

/// Second moments about one axis below this part of the largest: a line.
constexpr double kLine = 1e-9;

}  // namespace

RemoteMoments remote_moments(const TetMesh& mesh, const SurfaceWeights& weights,
                             const Surfaces& surfaces) {
  RemoteMoments result;
  result.area = weights.weights.sum();
  for (std::size_t k = 0; k < weights.nodes.size(); ++k) {
    result.centre += weights.weights[static_cast<Eigen::Index>(k)] /
                     result.area * mesh.nodes[weights.nodes[k]];
  }
  Mat3 inertia = Mat3::Zero();
  for (std::size_t k = 0; k < weights.nodes.size(); ++k) {
    const Vec3 d = mesh.nodes[weights.nodes[k]] - result.centre;
    inertia += weights.weights[static_cast<Eigen::Index>(k)] *
               (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
  }
  const auto eigen = symmetric_eigen(inertia);
  if (!(eigen.values[0] > kLine * eigen.values[2])) {
    throw InvalidInput(fmt::format(
        "surface '{}': its nodes lie on a line and cannot carry the moment of "
        "a remote load",
        surfaces.text()));
  }
  result.inverse = eigen.vectors * eigen.values.cwiseInverse().asDiagonal() *
                   eigen.vectors.transpose();
  return result;
}

Points remote_forces(const TetMesh& mesh, const SurfaceWeights& weights,
                     const RemoteLoad& load) {
  const RemoteMoments moments = remote_moments(mesh, weights, load.surfaces);
  const Vec3 turn =
      moments.inverse *
      (load.moment + (load.point - moments.centre).cross(load.force));
  Points forces;
  forces.reserve(weights.nodes.size());
  for (std::size_t k = 0; k < weights.nodes.size(); ++k) {
    const Vec3 d = mesh.nodes[weights.nodes[k]] - moments.centre;
    forces.emplace_back(weights.weights[static_cast<Eigen::Index>(k)] *
                        (load.force / moments.area + turn.cross(d)));
  }
  return forces;
}

}  // namespace meniscus::loads
