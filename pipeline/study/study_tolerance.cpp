#include <fmt/format.h>

#include "optimize/samples/sampling.h"
#include "pipeline/case_data/studied_responses.h"
#include "pipeline/study/run_kind.h"

namespace meniscus::study {

namespace {

/// Normal designs about the start; only what scatters takes a dimension.
std::vector<VectorX> scattered_designs(const StudyTask& task) {
  const case_data::StudyEntry& study = task.input.study;
  std::vector<Eigen::Index> moving;
  moving.reserve(study.deviations.size());
  for (std::size_t j = 0; j < study.deviations.size(); ++j) {
    if (study.deviations[j] > 0.0) {
      moving.push_back(static_cast<Eigen::Index>(j));
    }
  }
  const int dimension = static_cast<int>(moving.size());
  samples::Samples samples =
      study.method == "sobol"
          ? samples::sobol_samples(dimension, study.count)
          : samples::latin_hypercube_samples(
                dimension, study.count, static_cast<std::uint64_t>(study.seed));
  for (VectorX& sample : samples) {
    VectorX all = VectorX::Constant(task.start.size(), 0.5);
    all(moving) = sample;
    sample = std::move(all);
  }
  return samples::normal_designs(
      task.start,
      Eigen::Map<const VectorX>(study.deviations.data(), task.start.size()),
      samples);
}

/// False when there is no gradient; the outcome then says why.
bool spread_by_gradient(const StudyTask& task, ToleranceFigures& figures,
                        StudyOutcome& outcome) {
  if (!uses_gradients(task.input)) {
    return true;  // samples alone
  }
  figures.responses = case_data::studied_responses(task.input);
  const optimize::JacobianAnswer answer =
      task.evaluator.gradient(task.start, figures.responses);
  if (answer.failure) {
    outcome.message =
        "no gradient at the initial design: " + answer.failure->message;
    return false;
  }
  figures.linear = samples::linear_spread(
      answer.jacobian(figures.responses, Eigen::all),
      Eigen::Map<const VectorX>(task.input.study.deviations.data(),
                                task.start.size()));
  return true;
}

/// The sampled confirmation, and what the study comes to with it.
void confirm(const StudyTask& task, ToleranceFigures& figures,
             StudyOutcome& outcome) {
  const std::vector<store::EvaluationRecord> records =
      task.evaluator.evaluate_all(scattered_designs(task), "sample");
  std::vector<VectorX> values;
  values.reserve(records.size());
  for (const store::EvaluationRecord& record : records) {
    if (!record.failure) {
      values.push_back(record.responses);
    }
  }
  figures.samples = static_cast<int>(records.size());
  figures.failed = figures.samples - static_cast<int>(values.size());
  if (values.size() >= 2) {
    figures.sampled = samples::sampled_spread(values);
  }
  if (figures.samples < task.input.study.count) {
    outcome.status = RunStatus::Stopped;
    outcome.message = fmt::format(
        "the time limit of {:g} s ended the confirmation after {} of {} "
        "samples; go on with --resume",
        task.options.time_limit, figures.samples, task.input.study.count);
  } else if (!figures.sampled) {
    outcome.status = RunStatus::Failed;
    outcome.message = fmt::format(
        "{} of {} samples cannot be evaluated: the film does not survive this "
        "scatter; try smaller study.deviations",
        figures.failed, figures.samples);
  } else {
    outcome.message += fmt::format(", confirmed by {} samples", values.size());
    if (figures.failed > 0) {
      outcome.warnings.push_back(fmt::format(
          "{} of {} samples cannot be evaluated and are left out: the scatter "
          "reaches designs without a part",
          figures.failed, figures.samples));
    }
  }
}

}  // namespace

StudyOutcome tolerance(const StudyTask& task) {
  task.evaluator.evaluate(task.start, "start");
  StudyOutcome outcome{.best = task.start};
  ToleranceFigures figures;
  if (spread_by_gradient(task, figures, outcome)) {
    outcome.status = RunStatus::Converged;
    outcome.message =
        figures.responses.empty()
            ? "the responses have no gradient"
            : fmt::format("the spread of {} responses by gradient",
                          figures.responses.size());
    if (task.input.study.count > 0) {
      confirm(task, figures, outcome);
    }
  }
  for (std::string& warning : tolerance_warnings(task.input, figures)) {
    outcome.warnings.push_back(std::move(warning));
  }
  outcome.tolerance = std::move(figures);
  return outcome;
}

}  // namespace meniscus::study
