/// What a match wants of the responses, as residuals for the optimizer and as
/// relative mismatch for the user's tolerance.
#pragma once

#include <string>
#include <vector>

#include "core/types.h"
#include "pipeline/case_data/case.h"

namespace meniscus::study {

/// `equal = [a, b, c]` gives one target per name after the first, against the
/// first; `targets = {a = value}` one each.
///
/// Residual: (a - b) / s, with s the mean magnitude at the initial design, a
/// constant: inside the bounds a response may change sign, and a ratio of
/// responses would then lose its meaning. Mismatch: |a - b| over the mean of
/// |a| and |b| as they are; of a target value v: |a - v| / |v|.
class MatchTargets {
 public:
  MatchTargets(const case_data::Case& input, const VectorX& initial_responses);

  VectorX residuals(const VectorX& responses) const;
  /// d residual / d x from d response / d x, of which only the rows of
  /// studied_responses() are read.
  Eigen::MatrixXd jacobian(const Eigen::MatrixXd& gradient) const;
  VectorX mismatch(const VectorX& responses) const;
  /// Largest error of each residual, and of each mismatch, that errors of the
  /// responses can make: errors of two responses add.
  VectorX residual_errors(const VectorX& errors) const;
  VectorX mismatch_errors(const VectorX& responses,
                          const VectorX& errors) const;
  std::string name(Eigen::Index target) const;

 private:
  struct Target {
    std::string name;
    Eigen::Index response = 0;
    Eigen::Index other = -1;  // -1: against `value`
    double value = 0.0;
    double scale = 1.0;
  };
  std::vector<Target> targets_;
};

}  // namespace meniscus::study
