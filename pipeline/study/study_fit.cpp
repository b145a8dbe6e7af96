#include <algorithm>

#include <fmt/format.h>

#include "pipeline/case_data/design_vectors.h"
#include "pipeline/responses/scans.h"
#include "pipeline/study/run_kind.h"
#include "pipeline/study/scan_match.h"

namespace meniscus::study {

namespace {

/// Without a tolerance of its own a fit goes on while distances fall.
constexpr double kNone = 1e-300;

/// A least-squares fit ends where nothing better is near: its answer.
bool is_least(optimize::Termination termination) {
  return termination == optimize::Termination::Converged ||
         termination == optimize::Termination::Stalled ||
         termination == optimize::Termination::AtBound;
}

/// "a = 40, 3 of t", of variables at a bound.
std::string bounds_reached(const case_data::Case& input, const VectorX& best) {
  constexpr double kAt = 1e-9;  // x the range
  std::string text;
  for (const case_data::DesignRow& row : case_data::design_rows(input)) {
    int reached = 0;
    for (std::size_t k = row.first; k < row.first + row.count; ++k) {
      const case_data::DesignVariable& v = input.design[k];
      const double value = best[static_cast<Eigen::Index>(k)];
      const double near = kAt * (v.upper - v.lower);
      reached += v.upper > v.lower &&
                         (value <= v.lower + near || value >= v.upper - near)
                     ? 1
                     : 0;
    }
    if (reached > 0) {
      text += text.empty() ? "" : ", ";
      text += row.vector == nullptr
                  ? fmt::format("{} = {}", row.name,
                                case_data::row_text(input, row, best))
                  : fmt::format("{} of {}", reached, row.name);
    }
  }
  return text;
}

}  // namespace

StudyOutcome fit_scan(const StudyTask& task) {
  const case_data::StudyEntry& study = task.input.study;
  const int response = *study.fit;
  const std::string& name =
      task.input.responses[static_cast<std::size_t>(response)].name;
  ScanMatch scan(task.input, task.evaluator.model(), response);
  std::string phase = "start";
  const optimize::MatchReport report = meniscus::optimize::match(
      variables_of(task.input, task.start),
      [&](const VectorX& x) {
        const store::EvaluationRecord record =
            task.evaluator.evaluate(x, phase);
        optimize::ResidualAnswer answer{.failure = record.failure};
        if (!record.failure) {
          answer.residuals = scan.residuals(x);
          answer.mismatch = VectorX::Constant(1, record.responses[response]);
        }
        return answer;
      },
      {.method = study.method,
       .tolerance = study.tolerance > 0.0 ? study.tolerance : kNone,
       .max_evaluations = study.max_evaluations,
       .earlier_evaluations = study.earlier_evaluations,
       .time_limit = task.options.time_limit,
       .monitor = task.options.monitor,
       .announce =
           [&](optimize::EvaluationPhase next) {
             phase = optimize::name_of(next);
           },
       .jacobian = [&](const VectorX& x) { return scan.jacobian(x); },
       .prefetch = prefetch_of(task)});
  StudyOutcome outcome{.status = status_of(report.termination),
                       .message = report.message,
                       .best = report.best,
                       .objective = report.cost,
                       .jacobian = report.jacobian};
  if (report.answer.mismatch.size() == 0) {
    return outcome;
  }
  const double rms = report.answer.mismatch[0];
  const std::string unit = case_data::response_unit(task.input, response);
  const bool wanted = study.tolerance > 0.0;
  const bool enough = !wanted || rms <= study.tolerance;
  if (is_least(report.termination)) {
    outcome.status = enough ? RunStatus::Converged : RunStatus::Infeasible;
    outcome.message =
        fmt::format("{} = {:.4g} {} over {} vertices, {} after {} evaluations",
                    name, rms, unit, report.answer.residuals.size(),
                    report.termination == optimize::Termination::Converged
                        ? "within its tolerance"
                        : "the least that the design variables allow",
                    report.evaluations);
    const std::string bounds = bounds_reached(task.input, report.best);
    if (!bounds.empty()) {
      outcome.warnings.push_back(
          fmt::format("at the end of its bounds: {}; wider bounds may come "
                      "nearer to the scan",
                      bounds));
    }
  }
  if (wanted) {
    outcome.constraints.push_back({.name = name,
                                   .value = rms,
                                   .bound = study.tolerance,
                                   .satisfied = enough});
  }
  return outcome;
}

}  // namespace meniscus::study
