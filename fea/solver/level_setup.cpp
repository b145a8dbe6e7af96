#include "fea/solver/level_setup.h"

#include <algorithm>

#include <Eigen/LU>

#include "core/math/dense.h"
#include "fea/solver/smoothed_aggregation.h"

namespace meniscus::solver {

namespace {}  // namespace

NodeFreedom corner_freedom(const NodeFreedom& fine, const CornerMap& map) {
  NodeFreedom result;
  result.nodes = static_cast<int>(map.corner.size());
  for (std::size_t k = 0; k < fine.held.size(); ++k) {
    const auto at =
        std::lower_bound(map.corner.begin(), map.corner.end(), fine.held[k]);
    if (at != map.corner.end() && *at == fine.held[k]) {
      result.held.push_back(static_cast<int>(at - map.corner.begin()));
      result.projector.push_back(fine.projector[k]);
    }
  }
  return result;
}

std::vector<double> inverse_blocks(const BlockMatrix<double>& matrix,
                                   double scale, const NodeFreedom& freedom) {
  std::vector<double> inverse(9L * freedom.nodes);
#pragma omp parallel for schedule(static) if (freedom.nodes >= kParallelRows)
  for (int i = 0; i < freedom.nodes; ++i) {
    Eigen::Map<RowMat3>(inverse.data() + 9L * i) =
        (Eigen::Map<const RowMat3>(matrix.diagonal.data() + 9L * i) / scale)
            .inverse();
  }
  for (std::size_t k = 0; k < freedom.held.size(); ++k) {
    const long at = 9L * freedom.held[k];
    const Mat3& P = freedom.projector[k];
    const RowMat3 D =
        Eigen::Map<const RowMat3>(matrix.diagonal.data() + at) / scale;
    const RowMat3 within = P * D * P + (Mat3::Identity() - P);
    Eigen::Map<RowMat3>(inverse.data() + at) = P * within.inverse() * P;
  }
  return inverse;
}

std::vector<double> inverse_blocks(const BlockMatrix<double>& matrix,
                                   int nodes) {
  using RowMat6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  std::vector<double> inverse(36L * nodes);
#pragma omp parallel for schedule(static) if (nodes >= kParallelRows)
  for (int i = 0; i < nodes; ++i) {
    RowMat6 D = Eigen::Map<const RowMat6>(matrix.diagonal.data() + 36L * i);
    RowMat6 none = RowMat6::Zero();
    for (int k = 0; k < 6; ++k) {
      none(k, k) = D(k, k) > 0.0 ? 0.0 : 1.0;
    }
    Eigen::Map<RowMat6>(inverse.data() + 36L * i) =
        inverse_of(RowMatrix6(D + none)) - none;
  }
  return inverse;
}

template <int B>
std::vector<float> padded(const std::vector<double>& blocks) {
  const std::size_t rows = blocks.size() / B;
  std::vector<float> result(rows * kLanes<B>, 0.0F);
  for (std::size_t r = 0; r < rows; ++r) {
    for (int c = 0; c < B; ++c) {
      result[r * kLanes<B> + c] = static_cast<float>(blocks[r * B + c]);
    }
  }
  return result;
}

std::vector<double> rigid_motions(const Points& x, const NodeFreedom& freedom) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : x) {
    centre += p / static_cast<double>(x.size());
  }
  double size = 0.0;
  for (const Vec3& p : x) {
    size = std::max(size, (p - centre).norm());
  }
  using Motions = Eigen::Matrix<double, 3, kRigidMotions, Eigen::RowMajor>;
  std::vector<double> result(18 * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 d = (x[i] - centre) / size;
    Motions m;
    m << 1, 0, 0, 0, d.z(), -d.y(),  //
        0, 1, 0, -d.z(), 0, d.x(),   //
        0, 0, 1, d.y(), -d.x(), 0;
    Eigen::Map<Motions>(result.data() + 18 * i) = m;
  }
  for (std::size_t k = 0; k < freedom.held.size(); ++k) {
    Eigen::Map<Motions> m(result.data() + 18L * freedom.held[k]);
    m = (freedom.projector[k] * m).eval();
  }
  return result;
}

template std::vector<float> padded<3>(const std::vector<double>& blocks);
template std::vector<float> padded<6>(const std::vector<double>& blocks);

}  // namespace meniscus::solver
