/// Variables held by equal bounds, taken out before a search and put back
/// after it.
#pragma once

#include "optimize/problem.h"

namespace meniscus::optimize {

class FreeVariables {
 public:
  explicit FreeVariables(const std::vector<Variable>& all);

  bool any_held() const {
    return free_.size() < static_cast<std::size_t>(size());
  }
  bool all_held() const { return free_.empty() && size() > 0; }
  const std::vector<Variable>& free() const { return free_; }
  Eigen::Index size() const { return values_.size(); }

  VectorX expanded(const VectorX& free) const;  // the held ones filled in
  std::vector<VectorX> expanded(const std::vector<VectorX>& free) const;
  /// The free variables' columns; a matrix without columns stays as it is.
  Eigen::MatrixXd reduced(const Eigen::MatrixXd& jacobian) const;
  /// The opposite, zero for the held ones.
  Eigen::MatrixXd widened(const Eigen::MatrixXd& jacobian) const;
  /// "no design variable can move: ..." with what to change.
  std::string held_message() const;

 private:
  std::vector<Variable> free_;
  std::vector<Eigen::Index> columns_;  // of the free ones
  VectorX values_;                     // initial, of all
  std::string first_held_;
};

}  // namespace meniscus::optimize
