/// Runs a case's study from the frozen model to the answer with its error.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/monitor.h"
#include "optimize/multipliers.h"
#include "pipeline/accuracy/mesh_errors.h"
#include "pipeline/case_data/case.h"
#include "pipeline/forward/adaptation.h"
#include "pipeline/forward/eigen_figures.h"
#include "pipeline/forward/element_errors.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/stress_figures.h"
#include "pipeline/responses/worst_loads.h"
#include "pipeline/store/refreeze.h"
#include "pipeline/store/study_store.h"
#include "pipeline/store/topology_events.h"
#include "pipeline/study/front_figures.h"
#include "pipeline/study/ledger.h"
#include "pipeline/study/progress_tracker.h"
#include "pipeline/study/sweep_figures.h"
#include "pipeline/study/tolerance_figures.h"

namespace meniscus::study {

enum class RunStatus {
  Converged,   // exit 0
  Infeasible,  // exit 3: no acceptable design exists or was found
  Stopped,     // exit 3: a limit was reached; best point kept
  Failed,      // exit 3: the initial design cannot be evaluated
  Error,       // exit 4
  Interrupted  // exit 130
};
const char* name_of(RunStatus status);

/// One target of the study: `value` is its relative mismatch.
struct Constraint {
  std::string name;
  double value = 0.0;
  double bound = 0.0;
  bool satisfied = false;
  // A margin's lower bound in the search, where higher than the case's, for the
  // mesh's error of it.
  std::optional<double> held;
};

/// What a first stage on a coarser model came to.
struct CoarseFigures {
  double edge_factor = 1.0;  // its edges over the case's
  VectorX design;            // its answer; empty where it has none
  std::string message;
  int evaluations = 0;
  int gradients = 0;
};

struct RunResult {
  RunStatus status = RunStatus::Failed;
  std::string message;  // why it ended, in words, with figures
  std::optional<forward::Evaluation> start;  // the initial design
  std::optional<forward::Evaluation> best;
  double objective = 0.0;  // of a match: sum of squared residuals / 2
  std::vector<Constraint> constraints;
  /// Of a minimum, where the search ended and on its model; none where it ended
  /// without derivatives, or the answer is another design.
  std::optional<optimize::Multipliers> multipliers;
  std::optional<SweepFigures> sweep;
  std::optional<ToleranceFigures> tolerance;
  std::optional<FrontFigures> front;
  VectorX response_errors;  // estimated discretisation errors; may be empty
  VectorX design_errors;    // of the matched variables; may be empty
  /// The responses on the meshes that the errors come from (mesh_errors.h):
  /// empty where one failed.
  std::array<VectorX, accuracy::kEdgeFactors.size()> meshes;
  VectorX finer_film;  // the same with the film on finer facets; may be empty
  std::vector<forward::StressFigures>
      stress;  // of the best design, per load case
  std::vector<responses::WorstLoad> worst_loads;  // of the best design
  forward::Exclusion exclusion;                   // what these leave out
  std::optional<forward::Adaptation> adaptation;  // at the initial design
  std::optional<forward::ElementErrors>
      element_errors;                          // the elements' part of them
  std::optional<forward::EigenFigures> eigen;  // of the best design
  std::optional<CoarseFigures> coarse;    // what study.coarse_first asked for
  std::vector<store::Refreeze> refrozen;  // models after the first, in order
  std::vector<store::TopologyEvent> topology;  // of the designs looked at
  /// Designs evaluated at the case's own resolution, each once per frozen
  /// model, finite-difference ones included: as many as the database holds.
  int evaluations = 0;
  /// The same by frozen model, in the order in which the models were made; of
  /// the last one the message tells.
  std::vector<std::pair<std::string, int>> evaluations_of_models;
  int failed_evaluations = 0;
  int gradient_evaluations = 0;
  forward::Evaluation frozen;    // the freeze of the case's own model
  std::optional<Ledger> ledger;  // once its files are written
  forward::StageSeconds
      seconds;  // summed over freeze, evaluations, error estimate
  double output_seconds = 0.0;
  double total_seconds = 0.0;
  std::vector<std::string> warnings;
};

struct StudyOptions {
  double time_limit = 0.0;      // [s], 0: none; the case may have its own
  bool estimate_errors = true;  // one more, coarser model
  int frames = 0;  // at most so many films of the design's history; 0: none
  int jobs = 1;  // independent designs side by side; no effect on what is found
  /// Where the optimizer starts, within the bounds; the model freezes at the
  /// case's initial design all the same, and that is the start where this one
  /// cannot be evaluated. None: the initial design.
  std::optional<VectorX> start = {};
  StudyListener listener = {};  // hears of every evaluation that is computed;
                                // then the monitor is not told of it
  /// Called once with the answer's meshes, solution and stresses, before its
  /// errors, buckling and the films of the history are computed: time for what
  /// can be made of them meanwhile. Must not keep the reference.
  std::function<void(const forward::EvaluationFields&)> answered = {};
  Monitor* monitor = nullptr;
};

/// Every evaluation is in `store` before the next begins; those that the store
/// holds already (--resume) are read and not computed. `fields`, when given,
/// receives the meshes of the best design. Interrupted passes through, after
/// the store has what was finished; TimeIsUp is thrown where the time limit
/// passes before a first design is evaluated.
RunResult run_study(const case_data::Case& input, store::StudyStore& store,
                    const StudyOptions& options,
                    forward::EvaluationFields* fields = nullptr);

}  // namespace meniscus::study
