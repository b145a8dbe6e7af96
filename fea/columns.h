/// Several long vectors side by side, with sums that do not depend on the
/// number of threads.
#pragma once

#include "fea/block_matrix.h"
#include "fea/nodal_matrix.h"
#include "fea/node_freedom.h"
#include "fea/preconditioner.h"

namespace meniscus {

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
void apply(const BlockPattern& pattern, const BlockMatrix<double>& A,
           const NodeFreedom& freedom, const ColumnsIn& x, ColumnsOut y);
void apply(const BlockPattern& pattern, const NodalMatrix& A,
           const NodeFreedom& freedom, const ColumnsIn& x, ColumnsOut y);
void apply(const Preconditioner& A, const NodeFreedom& freedom,
           const ColumnsIn& x, ColumnsOut y);

}  // namespace meniscus
