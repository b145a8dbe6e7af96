#include "fea/modes/pin_space.h"

#include "core/math/dense.h"

namespace meniscus::modes {

namespace {

Eigen::MatrixXd motions_of(const supports::PinFrame& pin, const Points& x) {
  Eigen::MatrixXd T(static_cast<Eigen::Index>(3 * pin.nodes.size()), 6);
  Eigen::Index count = 0;
  for (int k = 0; k < 6; ++k) {
    if (pin.fixed[k]) {
      continue;
    }
    for (std::size_t i = 0; i < pin.nodes.size(); ++i) {
      T.block<3, 1>(static_cast<Eigen::Index>(3 * i), count) =
          pin.motion(k, x[pin.nodes[i]]);
    }
    T.col(count++).normalize();
  }
  return T.leftCols(count);
}

Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& T) {
  if (T.cols() == 0) {
    return T;
  }
  const Eigen::MatrixXd G = T.transpose() * T;
  const auto eigen = symmetric_eigen(G);
  return T * eigen.vectors *
         eigen.values.cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace

PinSpace::PinSpace(const equations::ElasticOperator& op) {
  std::vector<char> pinned(static_cast<std::size_t>(op.freedom.nodes), 0);
  for (const supports::PinFrame& pin : op.pins) {
    pins_.push_back({pin.nodes, orthonormal_basis(motions_of(pin, op.x))});
    for (const int node : pin.nodes) {
      pinned[static_cast<std::size_t>(node)] = 1;
    }
  }
  freedom_.nodes = op.freedom.nodes;
  for (std::size_t h = 0; h < op.freedom.held.size(); ++h) {
    const int node = op.freedom.held[h];
    if (pinned[static_cast<std::size_t>(node)] == 0) {
      freedom_.held.push_back(node);
      freedom_.projector.push_back(op.freedom.projector[h]);
    }
  }
  const std::vector<VectorX>& Z = op.pin_motions.Z;
  const auto count = static_cast<Eigen::Index>(Z.size());
  Z_.resize(3L * freedom_.nodes, count);
  inverse_.resize(count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    Z_.col(k) = Z[static_cast<std::size_t>(k)];
    inverse_.col(k) =
        solve_ldlt(op.pin_motions.stiffness, VectorX::Unit(count, k));
  }
}

void PinSpace::project(solver::ColumnsOut v) const {
  for (const Pin& pin : pins_) {
    VectorX here(pin.T.rows());
    for (Eigen::Index k = 0; k < v.cols(); ++k) {
      for (std::size_t i = 0; i < pin.nodes.size(); ++i) {
        here.segment<3>(static_cast<Eigen::Index>(3 * i)) =
            v.block<3, 1>(3L * pin.nodes[i], k);
      }
      const VectorX rigid = pin.T * (pin.T.transpose() * here);
      for (std::size_t i = 0; i < pin.nodes.size(); ++i) {
        v.block<3, 1>(3L * pin.nodes[i], k) =
            rigid.segment<3>(static_cast<Eigen::Index>(3 * i));
      }
    }
  }
}

void PinSpace::hold(solver::ColumnsOut v) const {
  for (const Pin& pin : pins_) {
    for (const int node : pin.nodes) {
      v.middleRows<3>(3L * node).setZero();
    }
  }
}

void PinSpace::add_motions(const solver::ColumnsIn& forces,
                           const solver::ColumnsOut& v) const {
  if (Z_.cols() > 0) {
    solver::subtract(Z_, -inverse_ * solver::gram(Z_, forces), v);
  }
}

}  // namespace meniscus::modes
