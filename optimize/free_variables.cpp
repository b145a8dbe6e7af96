#include "optimize/free_variables.h"

#include <fmt/format.h>

namespace meniscus::optimize {

FreeVariables::FreeVariables(const std::vector<Variable>& all)
    : values_(static_cast<Eigen::Index>(all.size())) {
  for (std::size_t j = 0; j < all.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    values_[column] = all[j].initial;
    if (all[j].lower == all[j].upper) {
      first_held_ = first_held_.empty() ? all[j].name : first_held_;
    } else {
      free_.push_back(all[j]);
      columns_.push_back(column);
    }
  }
}

VectorX FreeVariables::expanded(const VectorX& free) const {
  VectorX x = values_;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    x[columns_[k]] = free[static_cast<Eigen::Index>(k)];
  }
  return x;
}

std::vector<VectorX> FreeVariables::expanded(
    const std::vector<VectorX>& free) const {
  std::vector<VectorX> all;
  all.reserve(free.size());
  for (const VectorX& x : free) {
    all.push_back(expanded(x));
  }
  return all;
}

Eigen::MatrixXd FreeVariables::reduced(const Eigen::MatrixXd& jacobian) const {
  if (jacobian.cols() != size()) {
    return jacobian;  // of a wrong size: the search says so
  }
  Eigen::MatrixXd part(jacobian.rows(),
                       static_cast<Eigen::Index>(columns_.size()));
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    part.col(static_cast<Eigen::Index>(k)) = jacobian.col(columns_[k]);
  }
  return part;
}

Eigen::MatrixXd FreeVariables::widened(const Eigen::MatrixXd& jacobian) const {
  if (jacobian.size() == 0) {
    return jacobian;
  }
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(jacobian.rows(), size());
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    all.col(columns_[k]) = jacobian.col(static_cast<Eigen::Index>(k));
  }
  return all;
}

std::string FreeVariables::held_message() const {
  return fmt::format(
      "no design variable can move: both bounds of '{}'{} are equal. Widen "
      "them, or analyse this one design",
      first_held_, size() > 1 ? " and of every other" : "");
}

}  // namespace meniscus::optimize
