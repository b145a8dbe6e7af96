#include "pipeline/study/match_targets.h"

#include <cmath>

#include <fmt/format.h>

#include "pipeline/case_data/response_entries.h"

namespace meniscus::study {

namespace {

double relative_difference(double a, double b) {
  const double mean = 0.5 * (std::abs(a) + std::abs(b));
  return mean > 0.0 ? std::abs(a - b) / mean : 0.0;
}

}  // namespace

MatchTargets::MatchTargets(const case_data::Case& input,
                           const VectorX& initial_responses) {
  const auto index = [&](const std::string& name) {
    return static_cast<Eigen::Index>(case_data::response_index(input, name));
  };
  const std::vector<std::string>& equal = input.study.equal;
  for (std::size_t k = 1; k < equal.size(); ++k) {
    Target target;
    target.name = fmt::format("{} = {}", equal[0], equal[k]);
    target.response = index(equal[0]);
    target.other = index(equal[k]);
    target.scale = 0.5 * (std::abs(initial_responses[target.response]) +
                          std::abs(initial_responses[target.other]));
    targets_.push_back(target);
  }
  for (const auto& [name, value] : input.study.targets) {
    Target target;
    target.name = fmt::format("{} = {}", name, value);
    target.response = index(name);
    target.value = value;
    target.scale = value != 0.0 ? std::abs(value)
                                : std::abs(initial_responses[target.response]);
    targets_.push_back(target);
  }
  for (Target& target : targets_) {
    if (target.scale == 0.0) {
      target.scale = 1.0;  // both 0: matched already, any scale serves
    }
  }
}

VectorX MatchTargets::residuals(const VectorX& responses) const {
  VectorX values(static_cast<Eigen::Index>(targets_.size()));
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    const Target& t = targets_[k];
    const double wanted = t.other >= 0 ? responses[t.other] : t.value;
    values[static_cast<Eigen::Index>(k)] =
        (responses[t.response] - wanted) / t.scale;
  }
  return values;
}

Eigen::MatrixXd MatchTargets::jacobian(const Eigen::MatrixXd& gradient) const {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(targets_.size()),
                         gradient.cols());
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    const Target& t = targets_[k];
    const auto row = static_cast<Eigen::Index>(k);
    result.row(row) = gradient.row(t.response) / t.scale;
    if (t.other >= 0) {
      result.row(row) -= gradient.row(t.other) / t.scale;
    }
  }
  return result;
}

VectorX MatchTargets::mismatch(const VectorX& responses) const {
  VectorX values(static_cast<Eigen::Index>(targets_.size()));
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    const Target& t = targets_[k];
    const double value = responses[t.response];
    values[static_cast<Eigen::Index>(k)] =
        t.other >= 0 ? relative_difference(value, responses[t.other])
                     : std::abs(value - t.value) / t.scale;
  }
  return values;
}

VectorX MatchTargets::residual_errors(const VectorX& errors) const {
  VectorX values(static_cast<Eigen::Index>(targets_.size()));
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    const Target& t = targets_[k];
    const double other = t.other >= 0 ? errors[t.other] : 0.0;
    values[static_cast<Eigen::Index>(k)] =
        (errors[t.response] + other) / t.scale;
  }
  return values;
}

VectorX MatchTargets::mismatch_errors(const VectorX& responses,
                                      const VectorX& errors) const {
  VectorX values = residual_errors(errors);
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    const Target& t = targets_[k];
    const double mean = t.other >= 0 ? 0.5 * (std::abs(responses[t.response]) +
                                              std::abs(responses[t.other]))
                                     : t.scale;
    values[static_cast<Eigen::Index>(k)] *= mean > 0.0 ? t.scale / mean : 1.0;
  }
  return values;
}

std::string MatchTargets::name(Eigen::Index target) const {
  return targets_[static_cast<std::size_t>(target)].name;
}

}  // namespace meniscus::study
