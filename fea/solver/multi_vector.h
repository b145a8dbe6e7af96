/// Several long vectors side by side, with sums that do not depend on the
/// number of threads.
#pragma once

#include "fea/solver/block_matrix.h"
#include "fea/solver/nodal_matrix.h"
#include "fea/solver/node_freedom.h"
#include "fea/solver/preconditioner.h"

namespace meniscus::solver {

/// One vector a column: 3 numbers per node, solver's numbering.
using Columns = Eigen::MatrixXd;
using ColumnsIn = Eigen::Ref<const Columns>;
using ColumnsOut = Eigen::Ref<Columns>;

/// a^T b.
Eigen::MatrixXd gram(const ColumnsIn& a, const ColumnsIn& b);

/// The first columns of `S` become S C, C having no more columns than S.
void combine(const Eigen::MatrixXd& C, ColumnsOut S);

/// b -= a C.
void subtract(const ColumnsIn& a, const Eigen::MatrixXd& C, ColumnsOut b);

/// Takes off what the columns have along held directions.
void project(const NodeFreedom& freedom, ColumnsOut v);

/// y = A x, up to four columns at a time, then projected. `x` is projected.
class ColumnProducts {
 public:
  /// Both are kept: they must outlive this.
  ColumnProducts(const BlockPattern& pattern, const NodeFreedom& freedom)
      : pattern_(pattern), freedom_(freedom) {}

  void apply(const BlockMatrix<double>& A, const ColumnsIn& x, ColumnsOut y);
  void apply(const NodalMatrix& A, const ColumnsIn& x, ColumnsOut y);
  void apply(const Preconditioner& A, const ColumnsIn& x, ColumnsOut y);

 private:
  template <class Product>
  void by_fours(const ColumnsIn& x, ColumnsOut& y, const Product& product);

  const BlockPattern& pattern_;
  const NodeFreedom& freedom_;
  std::vector<double> from_;  // up to four columns in padded layout
  std::vector<double> to_;
};

}  // namespace meniscus::solver
