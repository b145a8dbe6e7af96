#include "pipeline/case_data/study_kinds.h"

#include <algorithm>
#include <set>

#include "optimize/minimize.h"
#include "optimize/problem.h"
#include "pipeline/case_data/response_entries.h"

namespace meniscus::case_data {

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

std::vector<std::string> methods_of_minima() {
  std::vector<std::string> names;
  for (const optimize::MinimizeMethod& method : optimize::minimize_methods()) {
    names.push_back(method.name);
  }
  return names;
}

std::vector<std::string> sweep_methods() {
  return {"grid", "latin_hypercube", "sobol"};
}

/// A method may wait in the case, of any kind, while it is only analysed.
std::vector<std::string> methods_that_wait() {
  std::vector<std::string> names = optimize::match_methods();
  for (const auto& more : {methods_of_minima(), sweep_methods()}) {
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

bool by_ceres(const StudyEntry& study) { return study.method == "ceres"; }

bool by_slopes(const StudyEntry& study) {
  const optimize::MinimizeMethod* method =
      optimize::find_minimize_method(study.method);
  return method != nullptr && method->gradients;
}

int most_evaluations(const StudyEntry& study) { return study.max_evaluations; }

int designs_of_sweep(const StudyEntry& study) {
  int designs = study.method == "grid" ? 1 : study.count;
  for (const int level : study.levels) {
    designs *= study.method == "grid" ? std::max(level, 1) : 1;
  }
  return designs + 1;  // the start
}

}  // namespace

const std::vector<StudyRow>& study_kinds() {
  using Kind = StudyKind;
  static const std::vector<StudyRow> rows = {
      {.name = "analyse",
       .kind = Kind::Analyse,
       .methods = methods_that_wait(),
       .usual_method = "ceres",
       .outer_stage = "match",
       .gradients = by_ceres,
       .planned = [](const StudyEntry&) { return 1; }},
      {.name = "match",
       .kind = Kind::Match,
       .keys = {"equal", "targets", "fit", "tolerance", "max_evaluations",
                "coarse_first", "refreeze"},
       .methods = optimize::match_methods(),
       .usual_method = "ceres",
       .outer_stage = "match",
       .responses = matched_responses,
       .gradients = by_ceres,
       .planned = most_evaluations},
      {.name = "minimize",
       .kind = Kind::Minimize,
       .keys = {"objective", "constraints", "tolerance", "max_evaluations",
                "coarse_first", "refreeze"},
       .methods = methods_of_minima(),
       .usual_method = "slsqp",
       .outer_stage = "minimize",
       .responses = minimized_responses,
       .gradients = by_slopes,
       .planned = most_evaluations},
      {.name = "sweep",
       .kind = Kind::Sweep,
       .keys = {"objective", "constraints", "levels", "count", "seed",
                "refreeze"},
       .methods = sweep_methods(),
       .usual_method = "sobol",
       .outer_stage = "study",
       .planned = designs_of_sweep},
      {.name = "tolerance",
       .kind = Kind::Tolerance,
       .keys = {"deviations", "count", "seed"},
       .methods = {"latin_hypercube", "sobol"},
       .usual_method = "latin_hypercube",
       .outer_stage = "study",
       .responses = differentiable_responses,
       .gradients = [](const StudyEntry&) { return true; },
       .planned = [](const StudyEntry& study) { return study.count + 1; }},
      {.name = "pareto",  // a chain of minimisations: nobody knows how many
       .kind = Kind::Pareto,
       .keys = {"objectives", "constraints", "count", "tolerance",
                "max_evaluations"},
       .methods = methods_of_minima(),
       .usual_method = "slsqp",
       .outer_stage = "minimize",
       .responses = minimized_responses,
       .gradients = by_slopes}};
  return rows;
}

const StudyRow& row_of(StudyKind kind) {
  return *std::find_if(study_kinds().begin(), study_kinds().end(),
                       [&](const StudyRow& row) { return row.kind == kind; });
}

}  // namespace meniscus::case_data
