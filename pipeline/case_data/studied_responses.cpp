#include "pipeline/case_data/studied_responses.h"

#include <set>

#include "optimize/minimize.h"
#include "pipeline/case_data/response_entries.h"

namespace meniscus {

namespace {

std::vector<int> matched_responses(const Case& input) {
  std::set<int> result;
  for (const std::string& name : input.study.equal) {
    result.insert(response_index(input, name));
  }
  for (const auto& target : input.study.targets) {
    result.insert(response_index(input, target.first));
  }
  return {result.begin(), result.end()};
}

std::vector<int> minimized_responses(const Case& input) {
  std::vector<int> result;
  if (input.study.objective) {
    result.push_back(*input.study.objective);
  }
  for (const ConstraintEntry& constraint : input.study.constraints) {
    result.push_back(constraint.response);
  }
  if (input.study.second) {
    result.push_back(*input.study.second);
  }
  return result;
}

std::vector<int> differentiable_responses(const Case& input) {
  std::vector<int> result;
  for (int r = 0; r < static_cast<int>(input.responses.size()); ++r) {
    if (has_derivatives(input, r)) {
      result.push_back(r);
    }
  }
  return result;
}

}  // namespace

std::vector<int> studied_responses(const Case& input) {
  switch (input.study.kind) {
    case StudyKind::Match:
      return matched_responses(input);
    case StudyKind::Minimize:
    case StudyKind::Pareto:
      return minimized_responses(input);
    case StudyKind::Tolerance:
      return differentiable_responses(input);
    case StudyKind::Analyse:
    case StudyKind::Sweep:
      break;
  }
  return {};
}

bool asks_for_gradients(const StudyEntry& study) {
  if (study.kind == StudyKind::Sweep) {
    return false;
  }
  if (study.kind == StudyKind::Tolerance) {
    return true;
  }
  if (study.kind != StudyKind::Minimize && study.kind != StudyKind::Pareto) {
    return study.method == "ceres";
  }
  const MinimizeMethod* method = find_minimize_method(study.method);
  return method != nullptr && method->gradients;
}

}  // namespace meniscus
