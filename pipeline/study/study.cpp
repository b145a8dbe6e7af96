#include "pipeline/study/study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "core/timer.h"
#include "pipeline/accuracy/doubted_margins.h"
#include "pipeline/accuracy/mesh_errors.h"
#include "pipeline/forward/norm_peaks.h"
#include "pipeline/forward/part_warnings.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/accuracy_note.h"
#include "pipeline/study/film_frames.h"
#include "pipeline/study/run_kind.h"
#include "pipeline/study/study_monitor.h"
#include "pipeline/study/study_records.h"
#include "pipeline/study/study_stage.h"
#include "pipeline/study/time_limit.h"

namespace meniscus::study {

namespace {

// A study looks at its limit between evaluations; so much later [s] the one
// under way is given up.
constexpr double kLateness = 0.5;

// A model frozen this near to a design, x the ranges of the variables, is one
// of that design.
constexpr double kAtDesign = 1e-2;

// An answer that is not kept on a model frozen at it is sought there again, so
// often and this near to it, x the ranges of the variables: another mesh moves
// every figure by its own noise, so that a search without these bounds would
// find another answer on each. The last is within kAtDesign.
constexpr std::array<double, 4> kReaches = {1.0, 0.1, 0.03, 0.009};

// Bounds of margins to collapse are raised above their errors so often.
constexpr int kMostRaises = 3;

bool keeps_all(const StudyOutcome& outcome) {
  return std::all_of(outcome.constraints.begin(), outcome.constraints.end(),
                     [](const Constraint& c) { return c.satisfied; });
}

bool ended_by_limit(const StudyOutcome& outcome) {
  return outcome.status == RunStatus::Stopped && !outcome.unproven;
}

VectorX bounds_of(const std::vector<accuracy::FigureError>& errors) {
  VectorX bounds(static_cast<Eigen::Index>(errors.size()));
  for (std::size_t r = 0; r < errors.size(); ++r) {
    bounds[static_cast<Eigen::Index>(r)] = errors[r].bound;
  }
  return bounds;
}

/// What a point of a front is on a mesh of its own.
void judge_point(const case_data::Case& input, const VectorX& responses,
                 FrontPoint& point) {
  point.own_mesh = OwnMesh{.first = responses[*input.study.objective],
                           .second = responses[*input.study.second]};
  for (const Constraint& constraint : bound_constraints(input, responses)) {
    point.own_mesh->kept = point.own_mesh->kept && constraint.satisfied;
  }
}

/// From the frozen model to the answer with its error, step by step.
class StudyRun {
 public:
  StudyRun(const case_data::Case& input, store::StudyStore& store,
           const StudyOptions& options)
      : input_(input),
        case_(input),
        store_(store),
        options_(options),
        monitor_(options.monitor != nullptr ? *options.monitor
                                            : silent_monitor()),
        limit_(smaller_limit(options.time_limit, input.study.time_limit)),
        limited_(monitor_, limit_),
        hard_limit_(monitor_, limit_ > 0.0 ? limit_ + kLateness : 0.0) {
    options_.time_limit = limit_;
    options_.monitor = &hard_limit_;
  }

  RunResult run();
  /// Of the best design; or what there is of a surface that was not filled.
  forward::EvaluationFields release_fields() { return std::move(fields_); }

 private:
  void start_coarse();
  bool begin();
  bool study_in_time();
  void keep_best_in_time();
  bool may_refreeze() const;
  bool refreeze();
  bool go_on_at(store::Refreeze wanted);
  std::unique_ptr<StudyStage> stage_at(const store::Refreeze& refreeze,
                                       const std::string& name,
                                       const case_data::Case& input);
  void update_time_limit();
  int evaluations_left() const {
    return input_.study.max_evaluations - earlier_evaluations_ -
           stage_->evaluations();
  }
  void add_stage_totals();
  void conduct_study();
  void take_outcome();
  bool has_answer_to_judge() const;
  void judge_answer();
  void judge_front();
  bool raise_doubted_margins();
  void doubt_margins();
  bool finish_best();
  template <class Work>
  void run_if_time_left(const char* what, const Work& work);
  void keep_history();
  void solve_eigenproblems();
  void estimate_element_errors_of_best();
  void estimate_errors();
  bool is_judged(const VectorX& design) const {
    return judged_ && judged_->model == stage_->model_name() &&
           judged_->design == design;
  }
  accuracy::MeshSequence other_meshes(bool with_eigen);
  void combine_errors(const accuracy::MeshSequence& meshes);
  void warn();
  void count();

  const case_data::Case& input_;
  case_data::Case case_;  // with the bounds that the search keeps
  store::StudyStore& store_;
  StudyOptions options_;  // its start and time as stages leave them
  Monitor& monitor_;
  double limit_;                // [s], 0: none
  DeadlineMonitor limited_;     // of what may be left out at the end
  DeadlineMonitor hard_limit_;  // of what is computed before
  std::vector<std::string> left_out_;
  Timer timer_;
  std::unique_ptr<case_data::Case>
      frozen_;           // what the stage's model is frozen of, where
                         // that is not the case's initial design
  bool raised_ = false;  // bounds of margins, above those of the input
  // The last best design that was put on other meshes, of that model.
  struct OnOtherMeshes {
    std::string model;
    VectorX design;
    accuracy::MeshSequence meshes;
  };
  std::optional<OnOtherMeshes> judged_;
  std::unique_ptr<StudyStage> stage_;
  forward::EvaluationFields fields_;
  forward::StageSeconds own_seconds_;  // beside those of the evaluator
  int earlier_gradients_ = 0;          // of stages before this one
  int earlier_evaluations_ = 0;
  RunResult result_;
};

/// The answer of the coarser model is where the case's own starts.
void StudyRun::start_coarse() {
  if (!(input_.study.coarse_first > 1.0)) {
    return;
  }
  monitor_.log(Severity::Info, "first on a coarser model");
  CoarseStage coarse = run_coarse_stage(input_, store_, options_);
  own_seconds_ += coarse.seconds;
  if (coarse.best) {
    options_.start = coarse.best;
  } else {
    result_.warnings.push_back("the coarser model gave no start: " +
                               coarse.figures.message);
  }
  result_.coarse = std::move(coarse.figures);
  update_time_limit();
}

/// What a stage took is gone for the next.
void StudyRun::update_time_limit() {
  constexpr double kLeast = 1e-3;
  if (limit_ > 0.0) {
    options_.time_limit = std::max(limit_ - timer_.seconds(), kLeast);
  }
}

bool StudyRun::begin() {
  stage_ = std::make_unique<StudyStage>(case_, store_, options_);
  const forward::ForwardModel& model = stage_->evaluator().model();
  if (const forward::Adaptation* adaptation = model.adaptation()) {
    result_.adaptation = *adaptation;
  }
  result_.start = stage_->start();
  result_.frozen = model.frozen();
  if (stage_->failure()) {
    result_.status = RunStatus::Failed;
    result_.message = fmt::format("the initial design cannot be evaluated: {}",
                                  stage_->failure()->message);
    result_.best = stage_->start();
    if (model.failure()) {
      fields_.surface.base = model.unfilled_surface();
      fields_.findings = model.findings();
      const Points& film = model.film().reference().points;
      if (model.film().reference().failure && !film.empty()) {
        fields_.film = model.film().fine_mesh(film);
      }
    }
    return false;
  }
  return true;
}

void StudyRun::add_stage_totals() {
  own_seconds_ += stage_->evaluator().seconds();
  earlier_gradients_ += stage_->evaluator().counts().gradients;
  earlier_evaluations_ += stage_->evaluations();
}

/// A stage on a model frozen there, or null where it cannot be.
std::unique_ptr<StudyStage> StudyRun::stage_at(const store::Refreeze& refreeze,
                                               const std::string& name,
                                               const case_data::Case& input) {
  std::unique_ptr<StudyStage> stage;
  std::string reason = what_prevents([&] {
    stage = std::make_unique<StudyStage>(
        input, store_, options_,
        StageModel{.name = name, .reference = result_.start->responses});
  });
  if (stage != nullptr && !stage->failure()) {
    return stage;
  }
  if (stage != nullptr) {
    own_seconds_ += stage->evaluator().seconds();
    reason = stage->failure()->message;
  }
  result_.warnings.push_back(fmt::format(
      "{}, but no new model can be frozen there: {}", refreeze.reason, reason));
  return nullptr;
}

/// Goes on with a new model where the study has left the reach of the last;
/// false when there is none.
bool StudyRun::refreeze() {
  const StudyOutcome& outcome = stage_->outcome();
  if (!may_refreeze() || ended_by_limit(outcome) || evaluations_left() <= 0) {
    return false;
  }
  std::optional<store::Refreeze> wanted =
      stage_->wanted(outcome.best, outcome.status == RunStatus::Converged);
  if (!wanted) {
    return false;
  }
  return go_on_at(*std::move(wanted));
}

/// With a model frozen there; false where there is none.
bool StudyRun::go_on_at(store::Refreeze wanted) {
  monitor_.log(Severity::Info,
               fmt::format("a new model is frozen at evaluation {}: {}",
                           wanted.evaluation, wanted.reason));
  auto input = std::make_unique<case_data::Case>(
      store::frozen_at(frozen_ ? *frozen_ : case_, wanted.design));
  input->study.max_evaluations = std::max(1, evaluations_left());
  update_time_limit();
  std::unique_ptr<StudyStage> stage =
      stage_at(wanted, store::refrozen_model(wanted.evaluation), *input);
  if (stage == nullptr) {
    return false;
  }
  wanted.shift = stage->start().responses - wanted.responses;
  add_stage_totals();
  options_.start = wanted.go_on_from;
  stage_ = std::move(stage);
  frozen_ = std::move(input);
  result_.refrozen.push_back(std::move(wanted));
  return true;
}

/// One of a study that seeks designs, where its model is frozen elsewhere.
bool StudyRun::has_answer_to_judge() const {
  const case_data::StudyKind kind = input_.study.kind;
  const VectorX& best = stage_->outcome().best;
  return (kind == case_data::StudyKind::Match ||
          kind == case_data::StudyKind::Minimize ||
          kind == case_data::StudyKind::Pareto) &&
         best.size() > 0 && stage_->was_answered(best) &&
         store::design_distance(input_, best, stage_->start().design) >
             kAtDesign;
}

/// The mesh of an answer was dragged to it from another design: it is evaluated
/// on one of its own, and what is not kept there is not kept. Then the study
/// goes on from that model, so often.
void StudyRun::judge_answer() {
  if (input_.study.kind == case_data::StudyKind::Pareto) {
    return;
  }
  for (std::size_t round = 0; has_answer_to_judge(); ++round) {
    const StudyOutcome found = stage_->outcome();
    if (ended_by_limit(found) || limited_.expired()) {
      // Of no use yet: with a higher limit the study goes on from its model.
      result_.warnings.emplace_back(
          "a limit ended the study: its best design was not evaluated on a "
          "mesh of its own");
      return;
    }
    const store::EvaluationRecord record =
        *store_.find(stage_->model_name(), found.best);
    if (!go_on_at({.evaluation = record.number,
                   .design = found.best,
                   .reason = "the answer on a mesh of its own",
                   .shift = {},
                   .responses = record.responses})) {
      return;
    }
    stage_->judge(found, input_);
    const bool lost = keeps_all(found) && !keeps_all(stage_->outcome());
    if (!lost || !input_.study.refreeze || evaluations_left() <= 0 ||
        round >= kReaches.size()) {
      return;
    }
    monitor_.log(Severity::Info,
                 "not kept on a mesh of its own: the study goes on there");
    stage_->conduct(StudyStage::Leave::Late, kReaches[round]);
  }
}

bool StudyRun::may_refreeze() const {
  const case_data::StudyEntry& study = input_.study;
  return study.refreeze &&
         static_cast<int>(result_.refrozen.size()) < store::kMostRefreezes &&
         (study.kind == case_data::StudyKind::Match ||
          study.kind == case_data::StudyKind::Minimize);
}

/// Each point of a front on a mesh of its own, that of the part last: the
/// others tell how much of the front is the mesh's.
void StudyRun::judge_front() {
  StudyOutcome found = stage_->outcome();
  if (!found.front || found.best.size() == 0) {
    return;
  }
  for (FrontPoint& point : found.front->points) {
    const std::optional<store::EvaluationRecord> record =
        store_.find(stage_->model_name(), point.design);
    const bool of_part = point.design == found.best;
    if (!record || limited_.expired()) {
      left_out_.emplace_back("a point of the front on a mesh of its own");
      continue;
    }
    if (of_part) {
      continue;
    }
    store::Refreeze wanted{.evaluation = record->number,
                           .design = point.design,
                           .reason =
                               "a point of the front, on a mesh of its "
                               "own",
                           .shift = {},
                           .responses = record->responses};
    const case_data::Case input = store::frozen_at(input_, point.design);
    // A model that only looks: the study's answer is not of it.
    const std::unique_ptr<StudyStage> stage = stage_at(
        wanted, fmt::format("point of evaluation {}", record->number), input);
    if (stage != nullptr) {
      own_seconds_ += stage->evaluator().seconds();
      judge_point(input_, stage->start().responses, point);
    }
  }
  if (has_answer_to_judge()) {
    const store::EvaluationRecord record =
        *store_.find(stage_->model_name(), found.best);
    if (!go_on_at({.evaluation = record.number,
                   .design = found.best,
                   .reason = "the answer on a mesh of its own",
                   .shift = {},
                   .responses = record.responses})) {
      return;
    }
    for (FrontPoint& point : found.front->points) {
      if (point.design == found.best) {
        judge_point(input_, stage_->start().responses, point);
      }
    }
    stage_->judge(found, input_);
  }
}

/// True where a margin's bound was raised, for the study to go on with: the
/// answer's own margin is within the mesh's error of it, so that the film may
/// be there on this mesh alone.
bool StudyRun::raise_doubted_margins() {
  const StudyOutcome& outcome = stage_->outcome();
  case_data::Case& working = frozen_ ? *frozen_ : case_;
  const bool goes_on = input_.study.kind == case_data::StudyKind::Minimize &&
                       input_.study.refreeze && options_.estimate_errors &&
                       keeps_all(outcome) && !limited_.expired() &&
                       evaluations_left() > 0;
  if (!goes_on) {
    return false;
  }
  auto& constraints = working.study.constraints;
  const bool any = std::any_of(
      constraints.begin(), constraints.end(), [&](const auto& entry) {
        return accuracy::holds_margin(input_, entry) && entry.lower > 0.0;
      });
  if (!any) {
    return false;
  }
  if (!is_judged(outcome.best)) {
    judged_ = {stage_->model_name(), outcome.best, other_meshes(false)};
  }
  bool raised = false;
  for (const accuracy::DoubtedMargin& margin :
       accuracy::doubted_margins(input_, judged_->meshes.responses[0],
                                 bounds_of(accuracy::response_errors(
                                     input_, judged_->meshes, VectorX())))) {
    double& lower = constraints[margin.constraint].lower;
    if (!(lower > 0.0)) {
      continue;
    }
    lower = accuracy::raised_bound(margin, lower);
    raised = true;
    monitor_.log(Severity::Info,
                 fmt::format("'{}' is {:.2g}, and {}: the study goes on and "
                             "holds it at {:.2g}",
                             margin.name, margin.value,
                             accuracy::doubt_text(margin), lower));
    result_.warnings.push_back(fmt::format(
        "'{}' was {:.2g} at a first answer, and {}: it is held at {:.2g} or "
        "more, above its bound",
        margin.name, margin.value, accuracy::doubt_text(margin), lower));
  }
  if (raised) {
    raised_ = true;
    working.study.max_evaluations = std::max(1, evaluations_left());
  }
  return raised;
}

/// A margin that its own error makes nothing is no margin.
void StudyRun::doubt_margins() {
  if (input_.study.kind != case_data::StudyKind::Minimize ||
      result_.response_errors.size() == 0) {
    return;
  }
  for (const accuracy::DoubtedMargin& margin : accuracy::doubted_margins(
           input_, result_.best->responses, result_.response_errors)) {
    for (Constraint& constraint : result_.constraints) {
      if (constraint.name == margin.name) {
        constraint.satisfied = false;
      }
    }
    const std::string note = fmt::format(
        "'{}' is {:.2g} and {}: the film may be there on this mesh alone, so "
        "the bound is not kept; raise it{}, or shorten resolution.fea",
        margin.name, margin.value, accuracy::doubt_text(margin),
        std::isfinite(margin.error) ? " above the error" : "");
    result_.message += ". " + note;
    result_.warnings.push_back(note);
    if (result_.status == RunStatus::Converged) {
      result_.status = RunStatus::Infeasible;
    }
  }
}

void StudyRun::conduct_study() {
  using Leave = StudyStage::Leave;
  do {
    stage_->conduct(may_refreeze() ? Leave::Early : Leave::Late);
  } while (refreeze());
  if (stage_->stopped_early()) {
    stage_->conduct();
  }
  judge_answer();
  for (int k = 0; k < kMostRaises && raise_doubted_margins(); ++k) {
    stage_->conduct();
    judge_answer();
  }
  judge_front();
  if (const forward::Adaptation* adaptation =
          stage_->evaluator().model().adaptation()) {
    result_.adaptation = *adaptation;
  }
  take_outcome();
}

void StudyRun::take_outcome() {
  const StudyOutcome& outcome = stage_->outcome();
  result_.status = outcome.status;
  result_.message = outcome.message;
  result_.objective = outcome.objective;
  result_.constraints = outcome.constraints;
  result_.sweep = outcome.sweep;
  result_.tolerance = outcome.tolerance;
  result_.front = outcome.front;
  result_.warnings.insert(result_.warnings.end(), outcome.warnings.begin(),
                          outcome.warnings.end());
}

bool StudyRun::finish_best() {
  result_.best =
      stage_->evaluator().with_fields(stage_->outcome().best, fields_);
  if (result_.best->failure) {  // only an analysis can end here
    result_.status = RunStatus::Failed;
    result_.message = result_.best->failure->message;
    return false;
  }
  fields_.stresses =
      forward::part_stresses(fields_.mesh, fields_.inputs, fields_.solution);
  result_.stress = forward::stress_figures(fields_);
  result_.exclusion = fields_.exclusion;
  for (std::string& warning :
       forward::part_warnings(input_, fields_, result_.stress)) {
    result_.warnings.push_back(std::move(warning));
  }
  for (std::string& warning : forward::norm_warnings(
           input_, forward::norm_peaks(input_, result_.best->responses,
                                       result_.stress))) {
    result_.warnings.push_back(std::move(warning));
  }
  for (std::string& warning :
       forward::wall_warnings(stage_->evaluator().model())) {
    result_.warnings.push_back(std::move(warning));
  }
  for (std::string& warning : forward::process_warnings(input_, fields_.mesh)) {
    result_.warnings.push_back(std::move(warning));
  }
  return true;
}

/// What an answer can do without; told in the warnings where it is missing.
template <class Work>
void StudyRun::run_if_time_left(const char* what, const Work& work) {
  bool done = false;
  if (!limited_.expired()) {
    try {
      work();
      done = true;
    } catch (const Interrupted&) {
      if (monitor_.stop_requested()) {
        throw;
      }
    }
  }
  if (!done) {
    left_out_.emplace_back(what);
  }
}

void StudyRun::keep_history() {
  fields_.history =
      film_frames(input_, stage_->evaluator().model(),
                  kept_designs(input_, store_.all(), stage_->outcome().best,
                               options_.frames),
                  limited_);
}

void StudyRun::solve_eigenproblems() {
  monitor_.progress({.stage = "fea", .detail = "buckling, frequencies"});
  result_.eigen = forward::eigen_figures(
      input_, fields_, stage_->evaluator().model().elasticity(), &limited_);
  own_seconds_.fea += result_.eigen->seconds;
  fields_.modes = forward::mode_shapes(input_, *result_.eigen);
  for (std::string& warning : forward::buckling_warnings(*result_.eigen)) {
    result_.warnings.push_back(std::move(warning));
  }
}

void StudyRun::estimate_element_errors_of_best() {
  monitor_.progress({.stage = "accuracy", .detail = "dual solutions"});
  const Timer timer;
  forward::ElementErrors errors = forward::estimate_element_errors(
      input_, fields_, result_.best->responses,
      stage_->evaluator().model().elasticity());
  own_seconds_.fea += timer.seconds();
  if (errors.failure) {
    result_.warnings.push_back("no estimate of the elements' errors: " +
                               errors.failure->message);
  } else {
    result_.element_errors = std::move(errors);
  }
}

void StudyRun::estimate_errors() {
  estimate_element_errors_of_best();
  const bool with_eigen =
      result_.eigen && forward::deserve_errors(input_, *result_.eigen);
  const bool known = !with_eigen && is_judged(result_.best->design);
  accuracy::MeshSequence meshes =
      known ? std::move(judged_->meshes) : other_meshes(with_eigen);
  if (!meshes.has_others()) {
    result_.warnings.push_back(fmt::format(
        "no error estimate{}, neither coarser nor finer models can be "
        "evaluated: {}",
        result_.element_errors ? " beyond the elements' own part" : "",
        meshes.failures[accuracy::kFinerMesh]));
  }
  if (meshes.has_others() || result_.element_errors) {
    combine_errors(meshes);
  }
  if (with_eigen && meshes.has_others()) {
    meshes.eigen[0] = std::move(*result_.eigen);
    accuracy::add_eigen_errors(meshes);
    result_.eigen = std::move(meshes.eigen[0]);
  }
}

/// The best design on its own mesh and on others.
accuracy::MeshSequence StudyRun::other_meshes(bool with_eigen) {
  accuracy::MeshSequence meshes = accuracy::evaluate_on_other_meshes(
      frozen_ ? *frozen_ : case_, stage_->outcome().best,
      store_.find(stage_->model_name(), stage_->outcome().best)->responses,
      with_eigen, limited_);
  own_seconds_ += meshes.seconds;
  return meshes;
}

void StudyRun::combine_errors(const accuracy::MeshSequence& meshes) {
  const std::vector<accuracy::FigureError> errors = accuracy::response_errors(
      input_, meshes,
      result_.element_errors ? result_.element_errors->responses : VectorX());
  result_.response_errors = bounds_of(errors);
  result_.meshes = meshes.responses;
  for (std::string& warning :
       accuracy::unsettled_warnings(input_, meshes, errors)) {
    result_.warnings.push_back(std::move(warning));
  }
  if (stage_->targets() != nullptr && stage_->outcome().jacobian.size() > 0) {
    const Eigen::MatrixXd inverse = pseudo_inverse(stage_->outcome().jacobian);
    result_.design_errors =
        inverse.cwiseAbs() *
        stage_->targets()->residual_errors(result_.response_errors);
  }
}

void StudyRun::warn() {
  if (!left_out_.empty()) {
    result_.warnings.push_back(
        fmt::format("the time limit of {:g} s left no time for: {}",
                    limited_.limit(), fmt::join(left_out_, ", ")));
  }
  const std::string note =
      accuracy_note(input_, stage_->targets(), result_.best->responses,
                    result_.response_errors);
  if (!note.empty()) {
    result_.message += ". " + note;
    result_.warnings.push_back(note);
  }
}

void StudyRun::count() {
  add_stage_totals();
  for (const store::EvaluationRecord& record : store_.all()) {
    if (store::is_study_model(record.model)) {
      ++result_.evaluations;
      result_.failed_evaluations += record.failure ? 1 : 0;
      auto& models = result_.evaluations_of_models;
      const auto at = std::find_if(
          models.begin(), models.end(),
          [&](const auto& model) { return model.first == record.model; });
      ++(at != models.end() ? *at : models.emplace_back(record.model, 0))
            .second;
    }
  }
  result_.gradient_evaluations = earlier_gradients_;
  result_.seconds = own_seconds_;
}

/// The best of what was evaluated, where a computation outlasted the limit.
void StudyRun::keep_best_in_time() {
  hard_limit_.lift();
  std::vector<store::EvaluationRecord> records;
  if (stage_ != nullptr) {
    records = stage_->records();
  }
  const bool any = std::any_of(
      records.begin(), records.end(),
      [](const store::EvaluationRecord& record) { return !record.failure; });
  const std::string message =
      fmt::format("the time limit of {:g} s is over", limit_);
  if (!any) {
    throw TimeIsUp(message + " before a first design was evaluated");
  }
  const store::EvaluationRecord best = store::best_record(input_, records);
  StudyOutcome outcome{
      .status = RunStatus::Stopped, .message = message, .best = best.inputs};
  if (input_.study.kind == case_data::StudyKind::Minimize) {
    outcome.constraints = bound_constraints(input_, best.responses);
  }
  stage_->leave(std::move(outcome));
  take_outcome();
}

/// False where there is no answer. Throws TimeIsUp where the limit passes
/// before any design was evaluated.
bool StudyRun::study_in_time() {
  try {
    start_coarse();
    if (!begin()) {
      return false;
    }
    conduct_study();
  } catch (const Interrupted&) {
    if (monitor_.stop_requested() || !hard_limit_.expired()) {
      throw;
    }
    keep_best_in_time();
  }
  hard_limit_.lift();
  return true;
}

RunResult StudyRun::run() {
  if (study_in_time()) {
    if (finish_best()) {
      if (raised_) {
        result_.constraints =
            bound_constraints(input_, result_.best->responses);
      }
      if (options_.answered) {
        options_.answered(fields_);
      }
      run_if_time_left("buckling and frequencies",
                       [&] { solve_eigenproblems(); });
      if (options_.estimate_errors) {
        run_if_time_left("estimates of the errors", [&] { estimate_errors(); });
        doubt_margins();
      }
      if (options_.frames > 0) {
        run_if_time_left("films of the history", [&] { keep_history(); });
      }
    }
    warn();
  }
  count();
  result_.total_seconds = timer_.seconds();
  return std::move(result_);
}

}  // namespace

const char* name_of(RunStatus status) {
  switch (status) {
    case RunStatus::Converged:
      return "converged";
    case RunStatus::Infeasible:
      return "infeasible";
    case RunStatus::Stopped:
      return "stopped";
    case RunStatus::Failed:
      return "failed";
    case RunStatus::Error:
      return "error";
    case RunStatus::Interrupted:
      return "interrupted";
  }
  return "unknown";
}

RunResult run_study(const case_data::Case& input, store::StudyStore& store,
                    const StudyOptions& options,
                    forward::EvaluationFields* fields) {
  StudyRun run(input, store, options);
  RunResult result = run.run();
  if (fields != nullptr) {
    *fields = run.release_fields();
  }
  return result;
}

}  // namespace meniscus::study
