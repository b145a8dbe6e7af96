/// What frequencies and buckling make of eigenpairs alike.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "fea/equations/elastic_operator.h"
#include "fea/modes/eigenpairs.h"

namespace meniscus::modes {

/// largest_eigenpairs() of A against the operator's K; once more with a factor
/// in double precision where its preconditioner is not positive definite
/// (supports that hardly hold) and the part is not large. With `may_factor`
/// also where the search is slow, as far from the design that the
/// preconditioner is of.
EigenPairs eigenpairs_of(const equations::ElasticOperator& op,
                         const solver::NodalMatrix& A,
                         const solver::Columns& start,
                         const EigenOptions& options, bool may_factor = false);

/// `own` columns and after them `shapes` (mesh's numbering, may be null).
solver::Columns start_columns(const solver::NodeOrder& order,
                              const solver::Columns& own,
                              const std::vector<VectorX>* shapes);

/// Why there is no answer; nothing when the pairs converged.
std::optional<Failure> why_not(const EigenPairs& pairs,
                               const std::string& what);

/// x or -x: the first of the components within a millionth of the largest is
/// positive.
VectorX with_fixed_sign(VectorX x);

/// The largest length of a node's three numbers.
double largest_of_nodes(const VectorX& x);

}  // namespace meniscus::modes
