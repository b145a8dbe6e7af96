#include "fea/constrain.h"

namespace meniscus {

void constrain(const BlockPattern& pattern, const NodeFreedom& freedom,
               BlockMatrix<double>& matrix) {
  using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  if (freedom.held.empty()) {
    return;
  }
  std::vector<int> place(pattern.nodes, -1);
  for (std::size_t h = 0; h < freedom.held.size(); ++h) {
    place[freedom.held[h]] = static_cast<int>(h);
  }
  for (int i = 0; i < pattern.nodes; ++i) {
    for (int k = pattern.start[i]; k < pattern.start[i + 1]; ++k) {
      const int j = pattern.column[k];
      if (place[i] < 0 && place[j] < 0) {
        continue;
      }
      Eigen::Map<RowMat3> block(matrix.lower.data() + 9L * k);
      if (place[i] >= 0) {
        block = (freedom.projector[place[i]] * block).eval();
      }
      if (place[j] >= 0) {
        block = (block * freedom.projector[place[j]]).eval();
      }
    }
    if (place[i] >= 0) {
      Eigen::Map<RowMat3> block(matrix.diagonal.data() + 9L * i);
      const Mat3& P = freedom.projector[place[i]];
      const double scale = block.trace() / 3.0;
      block = (P * block * P + scale * (Mat3::Identity() - P)).eval();
    }
  }
}

VectorX project(const NodeFreedom& freedom, VectorX v) {
  for (std::size_t h = 0; h < freedom.held.size(); ++h) {
    auto at = v.segment<3>(3L * freedom.held[h]);
    at = (freedom.projector[h] * at).eval();
  }
  return v;
}

}  // namespace meniscus
