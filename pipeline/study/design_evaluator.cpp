#include "pipeline/study/design_evaluator.h"

#include <algorithm>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "pipeline/study/ordered_jobs.h"
#include "pipeline/study/study_records.h"

namespace meniscus::study {

namespace {

/// The rows of `responses` are all there.
bool has_rows(const Eigen::MatrixXd& gradient,
              const std::vector<int>& responses) {
  return gradient.size() > 0 &&
         std::all_of(responses.begin(), responses.end(),
                     [&](int r) { return gradient.row(r).allFinite(); });
}

}  // namespace

DesignEvaluator::DesignEvaluator(const case_data::Case& input,
                                 store::StudyStore& store,
                                 DesignEvaluatorOptions options)
    : input_(input),
      store_(store),
      options_(std::move(options)),
      monitor_(options_.monitor),
      model_(input,
             {.edge_factor = options_.edge_factor, .monitor = &monitor_}),
      seconds_(model_.frozen().seconds),
      tracker_(input, options_.model, options_.time_limit) {
  if (options_.listener) {
    for (const store::EvaluationRecord& record : store_.all()) {
      tracker_.add(record);
    }
  }
}

store::EvaluationRecord DesignEvaluator::keep(
    const forward::Evaluation& evaluation, const std::string& phase) {
  seconds_ += evaluation.seconds;
  store::EvaluationRecord record = make_record(input_, evaluation);
  record.model = options_.model;
  record.phase = phase;
  if (mismatch_ && !record.failure) {
    record.mismatch = mismatch_(record.responses);
  }
  record.number = store_.append(record);
  if (options_.listener) {
    options_.listener(tracker_.add_new(record));
  } else {
    monitor_.log(Severity::Info, describe(input_, record));
  }
  return record;
}

void DesignEvaluator::compute_last(const VectorX& design,
                                   forward::KeepStiffness keep) {
  last_ = {};  // memory: not two designs at a time
  last_.evaluation = model_.evaluate(
      design, &last_.fields,
      keep == forward::KeepStiffness::Yes ? &last_.adjoint : nullptr);
}

store::EvaluationRecord DesignEvaluator::evaluate(const VectorX& design,
                                                  const std::string& phase) {
  throw_if_stopped(monitor_, "the study");
  ++counts_.evaluations;
  std::optional<store::EvaluationRecord> record =
      store_.find(options_.model, design);
  if (!record) {
    compute_last(design, options_.with_gradients ? forward::KeepStiffness::Yes
                                                 : forward::KeepStiffness::No);
    record = keep(last_.evaluation, phase);
  }
  counts_.failed += record->failure ? 1 : 0;
  if (watch_) {
    watch_(*record);
  }
  return *std::move(record);
}

std::vector<VectorX> DesignEvaluator::missing(
    const std::vector<VectorX>& designs) const {
  std::vector<VectorX> result;
  std::set<std::vector<double>> seen;
  for (const VectorX& design : designs) {
    if (!store_.find(options_.model, design) &&
        seen.emplace(design.begin(), design.end()).second) {
      result.push_back(design);
    }
  }
  return result;
}

void DesignEvaluator::compute(const std::vector<VectorX>& designs,
                              const std::string& phase) {
  throw_if_stopped(monitor_, "the study");
  const std::vector<VectorX> wanted = missing(designs);
  const int count = static_cast<int>(wanted.size());
  std::vector<forward::Evaluation> found(wanted.size());
  StudyMonitor::Group group(monitor_, deadline_ ? &*deadline_ : nullptr);
  const auto tell = [&](int done) {
    monitor_.user().progress(
        {.stage = "study",
         .detail = fmt::format("{}: {} of {} designs", phase, done, count),
         .fraction = static_cast<double>(done) / count});
  };
  if (count > 0) {
    tell(0);
  }
  try {
    run_in_order({.count = count,
                  .jobs = options_.jobs,
                  .work =
                      [&](int k) {
                        throw_if_stopped(monitor_, "the study");
                        found[k] = model_.evaluate(wanted[k]);
                      },
                  .take =
                      [&](int k) {
                        keep(std::exchange(found[k], {}), phase);
                        tell(k + 1);
                      },
                  .cancel = [&] { group.cancel(); }});
  } catch (const Interrupted&) {
    const bool is_late = deadline_ && StudyMonitor::Clock::now() >= *deadline_;
    if (monitor_.user_stops() && !is_late) {
      throw;
    }  // else the time is up: what is done is kept
  }
}

std::vector<store::EvaluationRecord> DesignEvaluator::evaluate_all(
    const std::vector<VectorX>& designs, const std::string& phase) {
  compute(designs, phase);
  std::vector<store::EvaluationRecord> records;
  records.reserve(designs.size());
  for (const VectorX& design : designs) {
    std::optional<store::EvaluationRecord> record =
        store_.find(options_.model, design);
    if (!record) {
      break;
    }
    ++counts_.evaluations;
    counts_.failed += record->failure ? 1 : 0;
    records.push_back(*std::move(record));
  }
  return records;
}

void DesignEvaluator::prefetch(const std::vector<VectorX>& designs,
                               const std::string& phase) {
  compute(designs, phase);
}

void DesignEvaluator::limit_time(double seconds) {
  deadline_.reset();
  if (seconds > 0.0) {
    deadline_ = StudyMonitor::Clock::now() +
                std::chrono::duration_cast<StudyMonitor::Clock::duration>(
                    std::chrono::duration<double>(seconds));
  }
}

optimize::JacobianAnswer DesignEvaluator::gradient(
    const VectorX& design, const std::vector<int>& responses) {
  throw_if_stopped(monitor_, "the study");
  ++counts_.gradients;
  const store::EvaluationRecord record = *store_.find(options_.model, design);
  if (has_rows(record.gradient, responses)) {
    return {record.gradient, std::nullopt};
  }
  if (!is_last(design) || last_.adjoint.elastic.empty()) {
    compute_last(design, forward::KeepStiffness::Yes);
    seconds_ += last_.evaluation.seconds;
  }
  const forward::DesignGradient found =
      model_.gradient(last_.evaluation, last_.fields, last_.adjoint, responses);
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

forward::Evaluation DesignEvaluator::with_fields(
    const VectorX& design, forward::EvaluationFields& fields) {
  if (!is_last(design)) {
    monitor_.progress({.stage = "study", .detail = "the best design's fields"});
    compute_last(design, forward::KeepStiffness::No);
    seconds_ += last_.evaluation.seconds;
  }
  forward::StagedDesign last = std::exchange(last_, {});
  fields = std::move(last.fields);
  return std::move(last.evaluation);
}

}  // namespace meniscus::study
