#include "pipeline/study/study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <optional>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "core/timer.h"
#include "pipeline/accuracy/doubted_margins.h"
#include "pipeline/accuracy/mesh_errors.h"
#include "pipeline/case_data/composed_responses.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/norm_peaks.h"
#include "pipeline/forward/part_warnings.h"
#include "pipeline/forward/singular_places.h"
#include "pipeline/forward/worst_cases.h"
#include "pipeline/frames/film_frames.h"
#include "pipeline/store/incumbent.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/accuracy_note.h"
#include "pipeline/study/held_margins.h"
#include "pipeline/study/own_mesh.h"
#include "pipeline/study/run_kind.h"
#include "pipeline/study/study_models.h"
#include "pipeline/study/study_monitor.h"
#include "pipeline/study/study_records.h"
#include "pipeline/study/time_limit.h"

namespace meniscus::study {

namespace {

// A study looks at its limit between evaluations; so much later [s] the one
// under way is given up.
constexpr double kLateness = 0.5;

// Bounds of margins to collapse are raised for their errors so often; a search
// that ends so near to one keeps the margin.
constexpr int kMostRaises = 5;
constexpr double kRaisedBoundMissed = 1e-2;

/// With the limit and its monitor in place of the caller's.
StudyOptions limited_options(StudyOptions options, double limit,
                             Monitor& monitor) {
  options.time_limit = limit;
  options.monitor = &monitor;
  return options;
}

/// What the residuals' errors make of the variables; not a number of those that
/// the targets leave free.
VectorX matched_errors(const case_data::Case& input,
                       const Eigen::MatrixXd& jacobian,
                       const VectorX& residual_errors) {
  constexpr double kFree = 1e-3;  // share that moves without a residual
  VectorX ranges(jacobian.cols());
  for (Eigen::Index k = 0; k < ranges.size(); ++k) {
    ranges[k] = input.design[k].upper - input.design[k].lower;
  }
  const Eigen::MatrixXd scaled = jacobian * ranges.asDiagonal();
  const Eigen::MatrixXd inverse = pseudo_inverse(scaled);
  VectorX errors = ranges.cwiseProduct(inverse.cwiseAbs() * residual_errors);
  for (Eigen::Index k = 0; k < ranges.size(); ++k) {
    if (ranges[k] > 0.0 && 1.0 - inverse.row(k).dot(scaled.col(k)) > kFree) {
      errors[k] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return errors;
}

/// From the frozen model to the answer with its error, step by step.
class StudyRun {
 public:
  StudyRun(const case_data::Case& input, store::StudyStore& store,
           const StudyOptions& options)
      : input_(input),
        store_(store),
        monitor_(options.monitor != nullptr ? *options.monitor
                                            : silent_monitor()),
        limit_(smaller_limit(options.time_limit, input.study.time_limit)),
        limited_(monitor_, limit_),
        hard_limit_(monitor_, limit_ > 0.0 ? limit_ + kLateness : 0.0),
        options_(limited_options(options, limit_, hard_limit_)),
        models_(input, store, options_) {}

  RunResult run();
  /// Of the best design; or what there is of a surface that was not filled.
  forward::EvaluationFields release_fields() { return std::move(fields_); }

 private:
  StudyStage& stage() { return *models_.stage(); }
  bool begin();
  bool study_in_time();
  void keep_best_in_time();
  void conduct_study();
  VectorX best_responses() const { return models_.answer().responses; }
  std::optional<accuracy::FinerFilm> finer_film();
  std::optional<VectorX> errors_of_margins(bool proven);
  bool may_raise_margins();
  bool raise_margins_by(const VectorX& errors, Raise raise);
  bool raise_doubted_margins(bool proven);
  void foresee_margins();
  void take_outcome();
  void judge_by_own_bounds();
  bool finish_best();
  template <class Work>
  void run_if_time_left(const char* what, const Work& work);
  void keep_history();
  void solve_eigenproblems();
  void estimate_element_errors_of_best();
  void estimate_errors();
  bool is_judged(const VectorX& design) {
    return judged_ && judged_->model == stage().model_name() &&
           judged_->design == design;
  }
  accuracy::MeshSequence other_meshes(bool with_eigen);
  void combine_errors(const accuracy::MeshSequence& meshes);
  std::vector<accuracy::FigureError> peak_errors(
      const accuracy::MeshSequence& meshes) const;
  accuracy::MeshValues peak_values(const accuracy::MeshSequence& meshes,
                                   std::size_t load_case) const;
  void share_peak_errors();
  void add_ratio_errors();
  void warn();
  void count();

  const case_data::Case& input_;
  store::StudyStore& store_;
  Monitor& monitor_;
  double limit_;                // [s], 0: none
  DeadlineMonitor limited_;     // of what may be left out at the end
  DeadlineMonitor hard_limit_;  // of what is computed before
  StudyOptions options_;
  StudyModels models_;
  std::vector<std::string> left_out_;
  Timer timer_;
  // Warnings of the bounds of margins that were raised, by constraint.
  struct HeldAbove {
    double lower = 0.0;
    std::string warning;
  };
  std::map<std::size_t, HeldAbove> held_above_;
  // The last best design whose film was put on finer facets, of that model.
  struct OnFinerFacets {
    std::string model;
    VectorX design;
    accuracy::FinerFilm film;
  };
  std::optional<OnFinerFacets> judged_;
  forward::EvaluationFields fields_;
  forward::StageSeconds own_seconds_;  // beside those of the models
  RunResult result_;
};

bool StudyRun::begin() {
  models_.freeze();
  const forward::ForwardModel& model = stage().evaluator().model();
  if (const forward::Adaptation* adaptation = model.adaptation()) {
    result_.adaptation = *adaptation;
  }
  result_.start = stage().start();
  result_.frozen = model.frozen();
  if (stage().failure()) {
    result_.status = RunStatus::Failed;
    result_.message = fmt::format("the initial design cannot be evaluated: {}",
                                  stage().failure()->message);
    result_.best = stage().start();
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

/// The answer's film on finer facets; nothing where there is no time.
std::optional<accuracy::FinerFilm> StudyRun::finer_film() {
  const VectorX& best = stage().outcome().best;
  if (!is_judged(best)) {
    run_if_time_left("the errors of films", [&] {
      judged_ = {
          stage().model_name(), best,
          accuracy::evaluate_finer_film(stage().evaluator().model(), best,
                                        best_responses(), limited_)};
      own_seconds_.film += judged_->film.seconds;
    });
  }
  return is_judged(best) ? std::optional(judged_->film) : std::nullopt;
}

/// The errors of the answer's film figures; nothing where there is no time. Not
/// numbers where the answer is of a film that other facets have not.
std::optional<VectorX> StudyRun::errors_of_margins(bool proven) {
  if (!proven) {
    return VectorX::Constant(std::ssize(input_.responses),
                             std::numeric_limits<double>::quiet_NaN());
  }
  std::optional<accuracy::FinerFilm> finer = finer_film();
  if (!finer) {
    return std::nullopt;
  }
  accuracy::MeshSequence alone;
  alone.responses[0] = best_responses();
  alone.finer_film = *std::move(finer);
  return accuracy::bounds_of(
      accuracy::response_errors(input_, alone, VectorX()));
}

bool StudyRun::may_raise_margins() {
  return input_.study.refreeze && options_.estimate_errors &&
         holds_margins(models_.working()) && !limited_.expired() &&
         models_.evaluations_left() > 0;
}

/// True where a bound was raised.
bool StudyRun::raise_margins_by(const VectorX& errors, Raise raise) {
  const std::vector<RaisedMargin> raised =
      raise_margins(input_, best_responses(), errors, raise, models_.working());
  for (const auto& [margin, lower] : raised) {
    const std::string doubt = accuracy::doubt_text(margin);
    const std::string value = margin.shown.text(margin.value, 3);
    const std::string held = margin.shown.text(lower, 3);
    models_.log(
        fmt::format("'{}' is {}, and {}: the study goes on and holds it at {}",
                    margin.name, value, doubt, held));
    held_above_[margin.constraint] = {
        lower, fmt::format("'{}' was {} at an earlier design, and {}: the "
                           "search held it at {} or more{}",
                           margin.name, value, doubt, held, kHeldAbove)};
  }
  return !raised.empty();
}

/// True where a margin's bound was raised, for the study to go on with: the
/// answer's own margin misses it by the mesh's error, so that on shorter edges
/// it may not be kept, or another mesh has no film.
bool StudyRun::raise_doubted_margins(bool proven) {
  if (!may_raise_margins() || !all_kept(stage().outcome().constraints) ||
      (!proven && !models_.lost_film())) {
    return false;
  }
  const std::optional<VectorX> errors = errors_of_margins(proven);
  return errors && raise_margins_by(*errors, Raise::Doubted);
}

/// Before a search goes on from an answer's own mesh: else it would end on the
/// margin's bound, and another had to follow.
void StudyRun::foresee_margins() {
  if (may_raise_margins() &&
      nears_margins(models_.working(), best_responses())) {
    if (const std::optional<VectorX> errors = errors_of_margins(true)) {
      raise_margins_by(*errors, Raise::Foreseen);
    }
  }
}

void StudyRun::conduct_study() {
  const auto judge = [&] {
    return judge_answer(models_, limited_, [&] { foresee_margins(); });
  };
  models_.conduct();
  bool proven = judge();
  for (int k = 0; k < kMostRaises && raise_doubted_margins(proven); ++k) {
    search_again(models_, [&] { models_.conduct(); });
    proven = judge();
  }
  if (proven) {
    return_to_kept(models_);
  } else {
    stage().leave(without_own_mesh(stage().outcome()));
  }
  for (std::string& point : judge_front(models_, limited_)) {
    left_out_.push_back(std::move(point));
  }
  if (const forward::Adaptation* adaptation =
          stage().evaluator().model().adaptation()) {
    result_.adaptation = *adaptation;
  }
  take_outcome();
}

void StudyRun::take_outcome() {
  const StudyOutcome& outcome = stage().outcome();
  result_.status = outcome.status;
  result_.message = outcome.message;
  result_.objective = outcome.objective;
  result_.constraints = outcome.constraints;
  result_.multipliers = outcome.multipliers;
  result_.sweep = outcome.sweep;
  result_.tolerance = outcome.tolerance;
  result_.front = outcome.front;
  result_.warnings.insert(result_.warnings.end(), outcome.warnings.begin(),
                          outcome.warnings.end());
}

/// Raised bounds are for the search alone: the user's are what counts.
void StudyRun::judge_by_own_bounds() {
  const VectorX& responses = result_.best->responses;
  result_.constraints = bound_constraints(input_, responses);
  if (result_.status == RunStatus::Converged) {
    return;
  }
  if (result_.status != RunStatus::Infeasible ||
      !all_kept(result_.constraints)) {
    result_.message +=
        ". The bound of a margin stands above the case's own here, for the "
        "mesh's error of it: see the warnings";
    return;
  }
  const double missed =
      store::merit_of(models_.working().study, responses).violation;
  result_.status =
      missed < kRaisedBoundMissed ? RunStatus::Converged : RunStatus::Stopped;
  result_.message +=
      ". All bounds of the case are kept; what is missed was raised above one";
}

bool StudyRun::finish_best() {
  result_.best =
      stage().evaluator().with_fields(stage().outcome().best, fields_);
  if (result_.best->failure) {  // only an analysis can end here
    result_.status = RunStatus::Failed;
    result_.message = result_.best->failure->message;
    return false;
  }
  forward::find_stresses(input_, fields_);
  result_.stress = forward::stress_figures(fields_);
  result_.worst_loads = responses::worst_loads(
      input_,
      {fields_.inputs, fields_.mesh, fields_.solution, fields_.exclusion.what});
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
       forward::film_warnings(input_, result_.best->film)) {
    result_.warnings.push_back(std::move(warning));
  }
  for (std::string& warning :
       forward::wall_warnings(stage().evaluator().model())) {
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
  if (limited_.expired()) {
    left_out_.emplace_back(what);
    return;
  }
  try {
    const std::string prevented = what_prevents(work);
    if (!prevented.empty()) {
      result_.warnings.push_back(
          fmt::format("left out: {} ({})", what, prevented));
    }
  } catch (const Interrupted&) {
    if (monitor_.stop_requested()) {
      throw;
    }
    left_out_.emplace_back(what);
  } catch (const std::bad_alloc&) {
    result_.warnings.push_back(
        fmt::format("left out: {} (not enough memory)", what));
  }
}

void StudyRun::keep_history() {
  fields_.history = frames::film_frames(
      input_, stage().evaluator().model(),
      frames::kept_designs(input_, store_.all(), stage().outcome().best,
                           options_.frames),
      limited_);
}

void StudyRun::solve_eigenproblems() {
  monitor_.progress({.stage = "fea", .detail = "buckling, frequencies"});
  const forward::ForwardModel& model = stage().evaluator().model();
  result_.eigen = forward::eigen_figures(
      input_, fields_, fields_.shell ? nullptr : &model.elasticity(),
      &limited_);
  own_seconds_.fea += result_.eigen->seconds;
  fields_.modes = forward::mode_shapes(input_, *result_.eigen);
}

void StudyRun::estimate_element_errors_of_best() {
  monitor_.progress({.stage = "accuracy", .detail = "dual solutions"});
  const Timer timer;
  forward::ElementErrors errors = forward::estimate_element_errors(
      input_, fields_, result_.best->responses,
      stage().evaluator().model().elasticity());
  own_seconds_.fea += timer.seconds();
  if (errors.failure) {
    result_.warnings.push_back("no estimate of the elements' errors: " +
                               errors.failure->message);
  } else {
    result_.element_errors = std::move(errors);
  }
}

void StudyRun::estimate_errors() {
  if (!fields_.shell) {
    estimate_element_errors_of_best();
  }
  const bool with_eigen =
      result_.eigen && forward::deserve_errors(input_, *result_.eigen);
  accuracy::MeshSequence meshes = other_meshes(with_eigen);
  if (std::optional<accuracy::FinerFilm> finer = finer_film()) {
    meshes.finer_film = *std::move(finer);
  }
  if (!meshes.has_others()) {
    result_.warnings.push_back(fmt::format(
        "no error estimate{}, neither coarser nor finer models can be "
        "evaluated: {}",
        result_.element_errors ? " beyond the elements' own part" : "",
        meshes.failures[accuracy::kFinerMesh]));
  }
  if (meshes.has_others() || result_.element_errors ||
      meshes.finer_film.responses.size() > 0) {
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
      models_.working(), stage().outcome().best, best_responses(), with_eigen,
      limited_);
  own_seconds_ += meshes.seconds;
  return meshes;
}

/// Of each load case's peak, by its highest readings on the meshes, and by
/// what geometry and the readings say.
std::vector<accuracy::FigureError> StudyRun::peak_errors(
    const accuracy::MeshSequence& meshes) const {
  std::vector<accuracy::FigureError> errors;
  for (std::size_t k = 0; k < result_.stress.size(); ++k) {
    const forward::StressFigures& figures = result_.stress[k];
    accuracy::FigureError error = accuracy::figure_error(
        peak_values(meshes, k), forward::may_be_singular(fields_, figures)
                                    ? accuracy::FigureKind::Extreme
                                    : accuracy::FigureKind::Peak);
    error.bound = std::fmax(error.bound, forward::growth_of_peak(figures));
    error.bound = std::fmax(error.bound, forward::extrapolated_part(figures));
    // One that has no limit by geometry has its own warning.
    error.settles = error.settles || forward::has_no_limit(figures);
    errors.push_back(error);
  }
  return errors;
}

/// The highest reading of a load case's peak on each mesh.
accuracy::MeshValues StudyRun::peak_values(const accuracy::MeshSequence& meshes,
                                           std::size_t load_case) const {
  accuracy::MeshValues values = {
      result_.stress[load_case].readings.largest().von_mises};
  for (std::size_t m = 1; m < values.size(); ++m) {
    values[m] = load_case < meshes.peaks[m].size()
                    ? meshes.peaks[m][load_case]
                    : std::numeric_limits<double>::quiet_NaN();
  }
  return values;
}

/// A load case's peak and the responses that are the same one have one error,
/// the largest.
void StudyRun::share_peak_errors() {
  std::vector<std::size_t> peaks;
  for (std::size_t r = 0; r < input_.responses.size(); ++r) {
    if (input_.responses[r].kind == case_data::ResponseKind::MaxVonMises) {
      peaks.push_back(r);
    }
  }
  const auto shared = [&](std::size_t r) -> double& {
    return result_
        .stress[static_cast<std::size_t>(input_.responses[r].load_case)]
        .peak_error;
  };
  for (const std::size_t r : peaks) {
    shared(r) = std::fmax(
        shared(r), result_.response_errors[static_cast<Eigen::Index>(r)]);
  }
  for (const std::size_t r : peaks) {
    result_.response_errors[static_cast<Eigen::Index>(r)] = shared(r);
  }
  add_ratio_errors();
}

/// A ratio of stress is off by as large a part as the peak that it bounds, an
/// envelope by as much as what it has its value from.
void StudyRun::add_ratio_errors() {
  for (std::size_t r = 0; r < input_.responses.size(); ++r) {
    const case_data::ResponseEntry& response = input_.responses[r];
    double& error = result_.response_errors[static_cast<Eigen::Index>(r)];
    if (response.kind == case_data::ResponseKind::StressRatio) {
      const forward::StressFigures& figures =
          result_.stress[case_data::shown_load_case(input_, response)];
      error = std::fmax(error,
                        result_.best->responses[static_cast<Eigen::Index>(r)] *
                            figures.peak_error / figures.max_von_mises);
    } else if (response.kind == case_data::ResponseKind::Envelope) {
      const int part =
          case_data::extreme_part(response, result_.best->responses);
      error = std::fmax(error, result_.response_errors[part]);
    }
  }
}

void StudyRun::combine_errors(const accuracy::MeshSequence& meshes) {
  // 1. Each figure's own.
  const std::vector<accuracy::FigureError> peaks = peak_errors(meshes);
  const std::vector<accuracy::FigureError> errors = accuracy::response_errors(
      input_, meshes,
      result_.element_errors ? result_.element_errors->responses : VectorX(),
      peaks);
  result_.response_errors = accuracy::bounds_of(errors);
  for (std::size_t r = 0; r < input_.responses.size(); ++r) {
    double& error = result_.response_errors[static_cast<Eigen::Index>(r)];
    const double growth = forward::growth_of_mean(input_.responses[r], fields_);
    if (growth > 0.0) {
      error = std::fmax(error, growth);
    }
  }
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    result_.stress[k].peak_error = peaks[k].bound;
  }
  share_peak_errors();
  // 2. Which of them have no limit.
  result_.meshes = meshes.responses;
  result_.finer_film = meshes.finer_film.responses;
  for (std::string& warning :
       accuracy::unsettled_warnings(input_, meshes, errors)) {
    result_.warnings.push_back(std::move(warning));
  }
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    if (!peaks[k].settles) {
      result_.warnings.push_back(accuracy::unsettled_text(
          input_,
          fmt::format("the peak stress of '{}'", result_.stress[k].load_case),
          peak_values(meshes, k), {1.0, input_.units.pressure},
          Dimension::Pressure));
    }
  }
  // 3. What they make of a match's parameters.
  if (stage().targets() != nullptr && stage().outcome().jacobian.size() > 0) {
    result_.design_errors = matched_errors(
        input_, stage().outcome().jacobian,
        stage().targets()->residual_errors(result_.response_errors));
  }
}

void StudyRun::warn() {
  for (const auto& [constraint, held] : held_above_) {
    result_.warnings.push_back(held.warning);
    result_.constraints[constraint].held = held.lower;
  }
  for (std::string& warning : forward::factor_warnings(fields_)) {
    result_.warnings.push_back(std::move(warning));
  }
  if (result_.eigen) {  // whose errors are known by now
    for (std::string& warning : forward::eigen_warnings(*result_.eigen)) {
      result_.warnings.push_back(std::move(warning));
    }
  }
  if (!left_out_.empty()) {
    result_.warnings.push_back(
        fmt::format("the time limit of {:g} s left no time for: {}",
                    limited_.limit(), fmt::join(left_out_, ", ")));
  }
  const std::string note =
      accuracy_note(input_, stage().targets(), result_.best->responses,
                    result_.response_errors);
  if (!note.empty()) {
    result_.message += ". " + note;
    result_.warnings.push_back(note);
  }
}

void StudyRun::count() {
  models_.add_to(result_);
  // An earlier run may have ended at a limit, on a mesh that this one does not
  // come by.
  const auto is_counted = [&](const store::EvaluationRecord& record) {
    return store::is_study_model(record.model) &&
           (record.failure || record.model == store::kStudyModel ||
            std::any_of(
                result_.refrozen.begin(), result_.refrozen.end(),
                [&](const store::Refreeze& at) {
                  return store::refrozen_model(at.evaluation) == record.model ||
                         store::rejoined_model(at.evaluation) == record.model;
                }));
  };
  std::vector<store::EvaluationRecord> counted = store_.all();
  counted.erase(
      std::remove_if(counted.begin(), counted.end(),
                     [&](const auto& record) { return !is_counted(record); }),
      counted.end());
  result_.topology = store::topology_events(input_, counted);
  for (const store::EvaluationRecord& record : counted) {
    ++result_.evaluations;
    result_.failed_evaluations += record.failure ? 1 : 0;
    auto& models = result_.evaluations_of_models;
    const auto at = std::find_if(
        models.begin(), models.end(),
        [&](const auto& model) { return model.first == record.model; });
    ++(at != models.end() ? *at : models.emplace_back(record.model, 0)).second;
  }
  result_.seconds += own_seconds_;
}

/// The best of what was evaluated, where a computation outlasted the limit.
void StudyRun::keep_best_in_time() {
  hard_limit_.lift();
  std::vector<store::EvaluationRecord> records;
  if (models_.stage() != nullptr) {
    records = stage().records();
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
  stage().leave(std::move(outcome));
  take_outcome();
}

/// False where there is no answer. Throws TimeIsUp where the limit passes
/// before any design was evaluated.
bool StudyRun::study_in_time() {
  try {
    result_.coarse = models_.run_coarse();
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
      if (!held_above_.empty()) {
        judge_by_own_bounds();
      }
      if (options_.answered) {
        options_.answered(fields_);
      }
      run_if_time_left("buckling and frequencies",
                       [&] { solve_eigenproblems(); });
      if (options_.estimate_errors) {
        run_if_time_left("estimates of the errors", [&] { estimate_errors(); });
        doubt_margins(input_, result_);
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
