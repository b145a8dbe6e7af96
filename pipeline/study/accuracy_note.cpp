#include "pipeline/study/accuracy_note.h"

#include <fmt/format.h>

#include "optimize/minimize.h"
#include "pipeline/case_data/studied_responses.h"

namespace meniscus::study {

namespace {

std::string of_match(const case_data::Case& input, const MatchTargets& targets,
                     const VectorX& responses, const VectorX& errors) {
  const double error = targets.mismatch_errors(responses, errors).maxCoeff();
  if (!(error > input.study.tolerance)) {
    return "";
  }
  return fmt::format(
      "The tolerance {:.1e} is below the mesh's own error of the mismatch, "
      "about {:.1e}. Shorten resolution.fea to trust more digits",
      input.study.tolerance, error);
}

std::string of_minimum(const case_data::Case& input, const VectorX& responses,
                       const VectorX& errors) {
  const std::vector<int> studied = case_data::studied_responses(input);
  const auto size = static_cast<Eigen::Index>(studied.size());
  optimize::MinimizeReport report;
  report.values.resize(size);
  VectorX value_errors(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const int response = studied[static_cast<std::size_t>(k)];
    report.values[k] = responses[response];
    value_errors[k] = errors[response];
  }
  report.objective = report.values[0];
  for (std::size_t k = 0; k < input.study.constraints.size(); ++k) {
    const case_data::ConstraintEntry& constraint = input.study.constraints[k];
    const auto response = static_cast<std::size_t>(constraint.response);
    report.constraints.push_back(
        {.name = input.responses[response].name,
         .shown = case_data::shown_unit(input, constraint.response),
         .value = report.values[static_cast<Eigen::Index>(k) + 1],
         .lower = constraint.lower,
         .upper = constraint.upper});
  }
  const auto objective = *input.study.objective;
  return optimize::precision_note(
      {.objective = input.responses[objective].name}, report,
      input.study.tolerance, value_errors);
}

}  // namespace

std::string accuracy_note(const case_data::Case& input,
                          const MatchTargets* targets, const VectorX& responses,
                          const VectorX& errors) {
  if (errors.size() == 0) {
    return "";
  }
  if (targets != nullptr) {
    return of_match(input, *targets, responses, errors);
  }
  return input.study.kind == case_data::StudyKind::Minimize
             ? of_minimum(input, responses, errors)
             : "";
}

}  // namespace meniscus::study
