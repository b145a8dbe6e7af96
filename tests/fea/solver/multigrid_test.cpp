// The pieces of the multigrid solver: chunks, sweeps, aggregates.
#include "fea/solver/multigrid.h"

#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "fea/solver/block_kernels.h"
#include "fea/solver/block_sweeps.h"
#include "fea/solver/smoothed_aggregation.h"
#include "tests/support/parts.h"

namespace meniscus::multigrid_test {
namespace {

using Blocks6 = Eigen::Matrix<double, 3, 6, Eigen::RowMajor>;

/// A mesh in the solver's numbering, with its stiffness.
struct Ordered {
  solver::NodeOrder order;
  solver::ElementTable table;
  Points x;
  solver::BlockMatrix<double> matrix;
};

Ordered ordered(const TetMesh& mesh) {
  Ordered result;
  result.order = solver::chunked_order(mesh);
  std::vector<int> elements;
  for (const int e : result.order.element) {
    for (const int node : mesh.element(e)) {
      elements.push_back(result.order.to_solver[node]);
    }
  }
  for (const int node : result.order.to_mesh) {
    result.x.push_back(mesh.nodes[node]);
  }
  result.table = solver::make_element_table(
      result.order.chunks, mesh.nodes_per_element(), elements,
      std::vector<int>(mesh.element_count(), 0));
  EXPECT_FALSE(solver::assemble(
      result.table, result.x, {element::lame(parts::steel())}, result.matrix));
  return result;
}

TetMesh many_chunks() {
  return shapes::straight_quadratic(parts::distorted_brick({3, 2, 1}, 9));
}

TEST(Chunks, NoNodeNeighboursTwoOfOneColour) {
  const TetMesh mesh = many_chunks();
  const solver::NodeOrder order = solver::chunked_order(mesh);
  const solver::RowChunks& chunks = order.chunks;
  ASSERT_GT(chunks.count(), 3 * chunks.colours());
  std::vector<int> chunk(mesh.nodes.size());
  std::vector<int> colour(mesh.nodes.size());
  for (int k = 0; k < chunks.colours(); ++k) {
    for (int c = chunks.colour[k]; c < chunks.colour[k + 1]; ++c) {
      for (int i = chunks.first[c]; i < chunks.first[c + 1]; ++i) {
        chunk[i] = c;
        colour[i] = k;
      }
    }
  }
  std::vector<std::map<int, std::set<int>>> met(mesh.nodes.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (const int a : mesh.element(e)) {
      for (const int b : mesh.element(e)) {
        const int other = order.to_solver[b];
        met[a][colour[other]].insert(chunk[other]);
      }
    }
  }
  for (const auto& colours : met) {
    for (const auto& entry : colours) {
      EXPECT_EQ(entry.second.size(), 1U);
    }
  }
  std::vector<int> sorted = order.to_mesh;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    ASSERT_EQ(sorted[i], static_cast<int>(i));
  }
}

/// Padded single-precision vectors of one column.
struct Sweeps {
  explicit Sweeps(const Ordered& ordered)
      : part(ordered), smoother(solver::make_smoother_matrix(ordered.matrix)) {
    for (int i = 0; i < part.table.pattern.nodes; ++i) {
      const Eigen::Matrix3d D =
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
              part.matrix.diagonal.data() + 9L * i) /
          smoother.scale;
      const Eigen::Matrix3d I = D.inverse();
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
          inverse.push_back(c < 3 ? static_cast<float>(I(r, c)) : 0.0F);
        }
      }
    }
  }
  solver::SweepMatrix matrix() const {
    return {&part.table.pattern, smoother.lower.data(), inverse.data()};
  }
  std::vector<float> zero() const {
    return std::vector<float>(4L * part.table.pattern.nodes, 0.0F);
  }
  std::vector<float> wave(double step) const {
    std::vector<float> v = zero();
    for (std::size_t d = 0; d < v.size(); ++d) {
      v[d] = d % 4 < 3
                 ? static_cast<float>(std::sin(step * static_cast<double>(d)))
                 : 0.0F;
    }
    return v;
  }
  const Ordered& part;
  solver::SmootherMatrix smoother;
  std::vector<float> inverse;
};

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t d = 0; d < a.size(); ++d) {
    sum += d % 4 < 3 ? static_cast<double>(a[d]) * b[d] : 0.0;
  }
  return sum;
}

constexpr double kSingle = 1e-4;  // sums of single precision

TEST(Sweeps, ForwardLeavesTheResidualAndBackwardIsItsAdjoint) {
  const Ordered part = ordered(many_chunks());
  const Sweeps s(part);
  const std::vector<float> a = s.wave(0.7);
  const std::vector<float> b = s.wave(1.3);
  // What stands in them is not read.
  std::vector<float> x(a.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<float> upper = x;
  solver::sweep_forward<3, 1>(s.matrix(), a.data(), x.data(), upper.data());
  std::vector<double> wide(x.begin(), x.end());
  std::vector<double> product(wide.size(), 0.0);
  solver::multiply<3, 1>(part.table.pattern, part.matrix, wide.data(),
                         product.data());
  double error = 0.0;
  for (std::size_t d = 0; d < a.size(); ++d) {
    if (d % 4 < 3) {
      error = std::max(
          error, std::abs(a[d] - product[d] / s.smoother.scale + upper[d]));
    }
  }
  EXPECT_LE(error, kSingle);
  std::vector<float> y = s.zero();
  upper = s.zero();
  solver::sweep_backward<3, 1>(s.matrix(), b.data(), y.data(), upper.data());
  EXPECT_NEAR(dot(b, x), dot(y, a), kSingle * std::sqrt(dot(x, x) * dot(b, b)));
}

Eigen::MatrixXd dense(const solver::BlockPattern& p,
                      const solver::BlockMatrix<double>& m, int B) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(B * p.nodes, B * p.nodes);
  using Row =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (int i = 0; i < p.nodes; ++i) {
    A.block(B * i, B * i, B, B) =
        Eigen::Map<const Row>(m.diagonal.data() + 1L * B * B * i, B, B);
    for (int k = p.start[i]; k < p.start[i + 1]; ++k) {
      const Row block =
          Eigen::Map<const Row>(m.lower.data() + 1L * B * B * k, B, B);
      A.block(B * i, B * p.column[k], B, B) = block;
      A.block(B * p.column[k], B * i, B, B) = block.transpose();
    }
  }
  return A;
}

TEST(Aggregation, CoarseOperatorIsGalerkinsAndRigidMotionsSurvive) {
  const Ordered part = ordered(parts::distorted_brick({3, 2, 1}, 5));
  const int n = part.table.pattern.nodes;
  std::vector<double> inverse(9L * n);
  std::vector<double> motions(18L * n);
  for (int i = 0; i < n; ++i) {
    using Row3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    Eigen::Map<Row3>(inverse.data() + 9L * i) =
        Eigen::Map<const Row3>(part.matrix.diagonal.data() + 9L * i).inverse();
    const Vec3& x = part.x[i];
    Blocks6 m;
    m << 1, 0, 0, 0, x.z(), -x.y(), 0, 1, 0, -x.z(), 0, x.x(), 0, 0, 1, x.y(),
        -x.x(), 0;
    Eigen::Map<Blocks6>(motions.data() + 18L * i) = m;
  }
  const solver::AggregateLevel level = solver::aggregate<3>(
      {&part.table.pattern, &part.matrix, &inverse, &motions});
  const int coarse = level.coarse.pattern.nodes;
  EXPECT_LT(coarse, n / 4);
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3 * n, 6 * coarse);
  Eigen::MatrixXd fine_motions(3 * n, 6);
  for (int i = 0; i < n; ++i) {
    for (int k = level.prolongation.start[i];
         k < level.prolongation.start[i + 1]; ++k) {
      P.block(3 * i, 6 * level.prolongation.column[k], 3, 6) =
          Eigen::Map<const Eigen::Matrix<float, 3, 6, Eigen::RowMajor>>(
              level.prolongation.value.data() + 18L * k)
              .cast<double>();
    }
    fine_motions.middleRows(3 * i, 3) =
        Eigen::Map<const Blocks6>(motions.data() + 18L * i);
  }
  Eigen::MatrixXd coarse_motions(6 * coarse, 6);
  for (int a = 0; a < coarse; ++a) {
    coarse_motions.middleRows(6 * a, 6) =
        Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(
            level.motions.data() + 36L * a);
  }
  const Eigen::MatrixXd A = dense(part.table.pattern, part.matrix, 3);
  const Eigen::MatrixXd galerkin = P.transpose() * A * P;
  EXPECT_LE(
      (dense(level.coarse.pattern, level.coarse.matrix, 6) - galerkin).norm(),
      1e-5 * galerkin.norm());  // P is stored in single precision
  EXPECT_LE((P * coarse_motions - fine_motions).norm(),
            1e-5 * fine_motions.norm());
}

}  // namespace
}  // namespace meniscus::multigrid_test
