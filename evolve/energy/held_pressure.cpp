#include "evolve/energy/held_pressure.h"

#include <Eigen/Core>

#include "core/math/dense.h"

namespace meniscus::energy {

VectorX guess_pressures(const films::FilmTargets& targets,
                        const std::vector<int>& held, const VectorX& gradient,
                        const Eigen::MatrixXd& slopes, const VectorX& metric) {
  VectorX pressure = VectorX::Zero(slopes.cols());
  for (Eigen::Index b = 0; b < slopes.cols(); ++b) {
    pressure[b] =
        targets.bodies[static_cast<std::size_t>(b)].pressure.value_or(0.0);
  }
  if (held.empty()) {
    return pressure;
  }
  const VectorX weight = metric.cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd b = slopes(Eigen::all, held);
  const VectorX residual = gradient - slopes * pressure;
  const VectorX right = b.transpose() * weight.cwiseProduct(residual);
  const Eigen::MatrixXd normal = b.transpose() * weight.asDiagonal() * b;
  const VectorX found = least_norm(normal, right);
  pressure(held) = found;
  return pressure;
}

}  // namespace meniscus::energy
