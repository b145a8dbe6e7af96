#include "pipeline/design_evaluator.h"

#include <algorithm>
#include <limits>

#include "pipeline/results.h"

namespace meniscus {

namespace {

/// The rows of `responses` are all there.
bool has_rows(const Eigen::MatrixXd& gradient,
              const std::vector<int>& responses) {
  return gradient.size() > 0 &&
         std::all_of(responses.begin(), responses.end(),
                     [&](int r) { return gradient.row(r).allFinite(); });
}

}  // namespace

DesignEvaluator::DesignEvaluator(const Case& input, StudyStore& store,
                                 DesignEvaluatorOptions options)
    : input_(input),
      store_(store),
      options_(std::move(options)),
      monitor_(options_.monitor != nullptr ? *options_.monitor
                                           : silent_monitor()),
      model_(input, {.edge_factor = options_.edge_factor,
                     .monitor = options_.monitor}),
      seconds_(model_.frozen().seconds) {}

EvaluationRecord DesignEvaluator::keep(const Evaluation& evaluation,
                                       const std::string& phase) {
  seconds_ += evaluation.seconds;
  EvaluationRecord record = make_record(input_, evaluation);
  record.model = options_.model;
  record.phase = phase;
  if (mismatch_ && !record.failure) {
    record.mismatch = mismatch_(record.responses);
  }
  record.number = store_.append(record);
  monitor_.log(Severity::Info, describe(input_, record));
  return record;
}

EvaluationRecord DesignEvaluator::evaluate(const VectorX& design,
                                           const std::string& phase) {
  throw_if_stopped(monitor_, "the study");
  ++counts_.evaluations;
  std::optional<EvaluationRecord> record = store_.find(options_.model, design);
  if (!record) {
    last_ = model_.evaluate(design, &last_fields_, adjoint_wanted());
    record = keep(last_, phase);
  }
  counts_.failed += record->failure ? 1 : 0;
  return *std::move(record);
}

JacobianAnswer DesignEvaluator::gradient(const VectorX& design,
                                         const std::vector<int>& responses) {
  throw_if_stopped(monitor_, "the study");
  ++counts_.gradients;
  const EvaluationRecord record = *store_.find(options_.model, design);
  if (has_rows(record.gradient, responses)) {
    return {record.gradient, std::nullopt};
  }
  if (!is_last(design) || last_adjoint_.elastic.empty()) {
    last_ = model_.evaluate(design, &last_fields_, &last_adjoint_);
    seconds_ += last_.seconds;
  }
  const DesignGradient found =
      model_.gradient(last_, last_fields_, last_adjoint_, responses);
  seconds_.gradient += found.seconds;
  if (found.failure) {
    monitor_.log(Severity::Warning, "no gradient: " + found.failure->message);
    return {{}, found.failure};
  }
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Constant(
      static_cast<Eigen::Index>(input_.responses.size()), design.size(),
      std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < responses.size(); ++k) {
    gradient.row(responses[k]) =
        found.jacobian.row(static_cast<Eigen::Index>(k));
  }
  store_.set_gradient(record.number, gradient);
  return {std::move(gradient), std::nullopt};
}

Evaluation DesignEvaluator::with_fields(const VectorX& design,
                                        EvaluationFields& fields) {
  if (!is_last(design)) {
    monitor_.progress({.stage = "study", .detail = "the best design's fields"});
    last_ = model_.evaluate(design, &last_fields_);
    seconds_ += last_.seconds;
  }
  Evaluation result = std::exchange(last_, {});
  fields = std::exchange(last_fields_, {});
  last_adjoint_ = {};
  return result;
}

}  // namespace meniscus
