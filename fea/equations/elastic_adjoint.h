/// Adjoint solutions: the sensitivity of a number to forces at the nodes.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/types.h"

namespace meniscus::elastic {
class ElasticModel;
}

namespace meniscus::equations {

struct KeptState;

/// The assembled stiffness and the restraints of one design, handed out by
/// ElasticModel::solve() when asked. Only for the model it comes from; about
/// as large as the stiffness matrix.
class ElasticState {
 public:
  ElasticState();  // empty
  ~ElasticState();
  ElasticState(ElasticState&&) noexcept;
  ElasticState& operator=(ElasticState&&) noexcept;

  bool empty() const { return kept_ == nullptr; }

 private:
  friend class elastic::ElasticModel;
  std::unique_ptr<KeptState> kept_;
};

/// K lambda = g on the free directions, lambda 0 along held ones.
struct AdjointSolution {
  std::vector<VectorX> lambda;  // 3 per node, one per right-hand side
  /// K lambda - g along held directions, as ElasticSolution::reactions.
  std::vector<VectorX> reactions;
  int iterations = 0;     // most over the right-hand sides
  double residual = 0.0;  // relative, largest over the right-hand sides
  double seconds = 0.0;
  std::optional<Failure> failure;
};

}  // namespace meniscus::equations
