#include "fea/remote_load.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"

namespace meniscus {

namespace {

/// Second moments about one axis below this part of the largest: a line.
constexpr double kLine = 1e-9;

}  // namespace

Points remote_forces(const TetMesh& mesh, const SurfaceWeights& weights,
                     const RemoteLoad& load) {
  const double area = weights.weights.sum();
  Vec3 centre = Vec3::Zero();
  for (std::size_t k = 0; k < weights.nodes.size(); ++k) {
    centre += weights.weights[static_cast<Eigen::Index>(k)] / area *
              mesh.nodes[weights.nodes[k]];
  }
  Mat3 inertia = Mat3::Zero();
  for (std::size_t k = 0; k < weights.nodes.size(); ++k) {
    const Vec3 d = mesh.nodes[weights.nodes[k]] - centre;
    inertia += weights.weights[static_cast<Eigen::Index>(k)] *
               (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(inertia);
  if (!(eigen.eigenvalues()[0] > kLine * eigen.eigenvalues()[2])) {
    throw InvalidInput(fmt::format(
        "surface '{}': its nodes lie on a line and cannot carry the moment of "
        "a remote load",
        load.surface));
  }
  const Vec3 moment = load.moment + (load.point - centre).cross(load.force);
  const Vec3 turn =
      eigen.eigenvectors() * (eigen.eigenvectors().transpose() * moment)
                                 .cwiseQuotient(eigen.eigenvalues());
  Points forces;
  forces.reserve(weights.nodes.size());
  for (std::size_t k = 0; k < weights.nodes.size(); ++k) {
    const Vec3 d = mesh.nodes[weights.nodes[k]] - centre;
    forces.emplace_back(weights.weights[static_cast<Eigen::Index>(k)] *
                        (load.force / area + turn.cross(d)));
  }
  return forces;
}

}  // namespace meniscus
