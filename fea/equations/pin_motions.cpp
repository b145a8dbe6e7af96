#include "fea/equations/pin_motions.h"

#include "core/math/dense.h"
#include "fea/supports/pins.h"

namespace meniscus::equations {

PinMotions find_pin_motions(const Points& x, HeldSolver& solver) {
  PinMotions result;
  std::vector<VectorX> unit;
  for (const supports::PinFrame& pin : solver.restraints().pins) {
    for (int k = 0; k < 6; ++k) {
      if (pin.fixed[k]) {
        continue;
      }
      VectorX& u = unit.emplace_back(
          VectorX::Zero(static_cast<Eigen::Index>(3 * x.size())));
      for (const int node : pin.nodes) {
        u.segment<3>(3L * node) = pin.motion(k, x[node]);
      }
    }
  }
  if (unit.empty()) {
    return result;
  }
  std::vector<VectorX> right;
  for (const VectorX& u : unit) {
    right.emplace_back(-solver.product(u));
    result.Z.emplace_back(VectorX::Zero(u.size()));
  }
  for (const solver::CgColumn& column : solver.solve(right, result.Z)) {
    result.column = worse_of(result.column, column);
  }
  const auto count = static_cast<Eigen::Index>(unit.size());
  result.stiffness.resize(count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    result.Z[k] += unit[k];
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    const VectorX Kz = solver.product(result.Z[k]);
    for (Eigen::Index l = 0; l < count; ++l) {
      result.stiffness(l, k) = result.Z[l].dot(Kz);
    }
  }
  return result;
}

void release_pins(const PinMotions& motions, const HeldSolver& solver,
                  const VectorX& f, VectorX& u) {
  if (motions.Z.empty()) {
    return;
  }
  const VectorX residual = f - solver.product(u);
  VectorX work(static_cast<Eigen::Index>(motions.Z.size()));
  for (Eigen::Index k = 0; k < work.size(); ++k) {
    work[k] = motions.Z[k].dot(residual);
  }
  const VectorX q = solve_ldlt(motions.stiffness, work);
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    u += q[k] * motions.Z[k];
  }
}

void hold_pins(const PinMotions& motions,
               const supports::Restraints& restraints, const Points& x,
               VectorX& u) {
  if (motions.Z.empty()) {
    return;
  }
  std::size_t next = 0;
  const VectorX given = u;
  for (const supports::PinFrame& pin : restraints.pins) {
    const supports::PinMotion near = supports::motion_of(pin, x, given);
    for (int k = 0; k < 6; ++k) {
      if (!pin.fixed[k]) {
        const double along = k < 3 ? pin.axes.col(k).dot(near.displacement)
                                   : pin.axes.col(k - 3).dot(near.rotation);
        u -= along * motions.Z[next++];
      }
    }
  }
}

solver::CgColumn worse_of(const solver::CgColumn& a,
                          const solver::CgColumn& b) {
  if ((a.end == solver::CgEnd::Converged) !=
      (b.end == solver::CgEnd::Converged)) {
    return a.end == solver::CgEnd::Converged ? b : a;
  }
  return b.iterations > a.iterations ? b : a;
}

}  // namespace meniscus::equations
