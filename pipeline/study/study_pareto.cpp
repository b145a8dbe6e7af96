#include <algorithm>

#include <fmt/format.h>

#include "core/timer.h"
#include "optimize/pareto.h"
#include "pipeline/study/run_kind.h"

namespace meniscus::study {

namespace {

/// The chain of minima along the front, by bounds on the second objective.
class FrontSearch {
 public:
  explicit FrontSearch(const StudyTask& task)
      : task_(task),
        problem_(minimize_problem(task, phase_)),
        second_(static_cast<int>(problem_.constraints.size()) - 1) {}

  StudyOutcome run();

 private:
  bool time_left() const {
    return task_.options.time_limit == 0.0 ||
           timer_.seconds() < task_.options.time_limit;
  }
  optimize::MinimizeReport minimum(optimize::MinimizeProblem problem,
                                   const VectorX& from);
  void keep(const optimize::MinimizeReport& report, bool swapped);
  void walk(const optimize::MinimizeReport& first,
            const optimize::MinimizeReport& last);
  void finish_outcome(StudyOutcome& outcome);

  const StudyTask& task_;
  std::string phase_ = "start";
  optimize::MinimizeProblem problem_;
  int second_;  // constraint that holds the second objective
  Timer timer_;
  bool out_of_time_ = false;
  std::vector<FrontPoint> found_;
  std::vector<std::vector<Constraint>> constraints_;  // of those
};

optimize::MinimizeReport FrontSearch::minimum(optimize::MinimizeProblem problem,
                                              const VectorX& from) {
  problem.variables = variables_of(task_.input, from);
  optimize::MinimizeOptions options = minimize_options(task_, phase_);
  if (options.time_limit > 0.0) {
    options.time_limit = std::max(options.time_limit - timer_.seconds(), 1e-3);
  }
  return meniscus::optimize::minimize(problem, options);
}

/// `swapped`: the report is of the exchanged problem.
void FrontSearch::keep(const optimize::MinimizeReport& report, bool swapped) {
  if (!report.feasible) {
    return;
  }
  FrontPoint point{.design = report.best,
                   .first = report.values[0],
                   .second = report.values[second_ + 1],
                   .end = optimize::name_of(report.termination)};
  if (swapped) {
    std::swap(point.first, point.second);
  }
  std::vector<Constraint> constraints;
  constraints.reserve(static_cast<std::size_t>(second_));
  for (int k = 0; k < second_; ++k) {  // the user's own
    constraints.push_back(
        to_constraint(report.constraints[static_cast<std::size_t>(k)]));
  }
  found_.push_back(std::move(point));
  constraints_.push_back(std::move(constraints));
}

/// From the least first objective to the least second one.
void FrontSearch::walk(const optimize::MinimizeReport& first,
                       const optimize::MinimizeReport& last) {
  const double worst = first.values[second_ + 1];
  const double best = last.values[0];
  const int between = task_.input.study.count - 2;
  if (between < 1 || !(best < worst)) {
    return;  // one design has the least of both
  }
  VectorX from = first.best;
  for (const double level : optimize::epsilon_levels(best, worst, between)) {
    if (!time_left()) {
      out_of_time_ = true;
      return;
    }
    const optimize::MinimizeReport report =
        minimum(optimize::with_upper_bound(problem_, second_, level), from);
    keep(report, false);
    if (report.feasible) {
      from = report.best;
    }
  }
}

void FrontSearch::finish_outcome(StudyOutcome& outcome) {
  std::vector<VectorX> values;
  values.reserve(found_.size());
  for (const FrontPoint& point : found_) {
    values.push_back(Eigen::Vector2d(point.first, point.second));
  }
  std::vector<int> front = optimize::pareto_front(values);
  std::sort(front.begin(), front.end(),
            [&](int a, int b) { return found_[a].first < found_[b].first; });
  FrontFigures figures;
  figures.left_out = static_cast<int>(found_.size() - front.size());
  figures.points.reserve(front.size());
  for (const int k : front) {
    figures.points.push_back(found_[k]);
  }
  const int middle = middle_of_front(figures.points);
  outcome.best = figures.points[middle].design;
  outcome.objective = figures.points[middle].first;
  outcome.constraints = constraints_[front[middle]];
  outcome.message = fmt::format(
      "a front of {} designs; the part is the one nearest to the least of both "
      "objectives",
      figures.points.size());
  outcome.status = RunStatus::Converged;
  if (figures.points.size() == 1) {
    outcome.message =
        "one design has the least of both objectives: they do not conflict";
  }
  if (out_of_time_) {
    outcome.status = RunStatus::Stopped;
    outcome.message += fmt::format("; the time limit of {:g} s ended it early",
                                   task_.options.time_limit);
  }
  const auto unsure = std::count_if(
      figures.points.begin(), figures.points.end(), [](const FrontPoint& p) {
        return p.end != optimize::name_of(optimize::Termination::Converged);
      });
  if (unsure > 0) {
    outcome.warnings.push_back(fmt::format(
        "{} points of the front are not converged minima (their `end` says "
        "why): raise study.max_evaluations",
        unsure));
  }
  outcome.front = std::move(figures);
}

StudyOutcome FrontSearch::run() {
  const optimize::MinimizeReport first = minimum(problem_, task_.start);
  keep(first, false);
  StudyOutcome outcome;
  if (!first.feasible) {
    outcome.status = status_of(first.termination);
    outcome.message = "the first objective alone: " + first.message;
    outcome.best = first.best;
    outcome.objective = first.objective;
    return outcome;
  }
  if (time_left()) {
    const optimize::MinimizeReport last =
        minimum(optimize::exchanged(problem_, second_), first.best);
    keep(last, true);
    if (last.feasible) {
      walk(first, last);
    }
  }
  out_of_time_ = out_of_time_ || !time_left();
  finish_outcome(outcome);
  return outcome;
}

}  // namespace

StudyOutcome pareto(const StudyTask& task) { return FrontSearch(task).run(); }

}  // namespace meniscus::study
