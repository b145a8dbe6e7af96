/// One study on one frozen model: what run_study() is made of (internal).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/timer.h"
#include "optimize/minimize.h"
#include "pipeline/match_targets.h"
#include "pipeline/study.h"

namespace meniscus {

class StudyRunner {
 public:
  StudyRunner(const Case& input, StudyStore& store, const StudyOptions& options)
      : input_(input),
        store_(store),
        options_(options),
        monitor_(options.monitor != nullptr ? *options.monitor
                                            : silent_monitor()) {}

  RunResult run(EvaluationFields* fields);

 private:
  EvaluationRecord evaluate(const VectorX& design, const std::string& phase);
  JacobianAnswer gradient(const VectorX& design,
                          const std::vector<int>& responses);
  void choose_begin();
  void conduct();
  void analyse();
  void match();
  void minimize();
  JacobianFunction match_jacobian();
  MinimizeProblem minimize_problem();
  /// last_ and its fields are of this design.
  bool is_last(const VectorX& design) const {
    return last_.design.size() == design.size() && last_.design == design;
  }
  AdjointState* adjoint_wanted() {
    return with_gradients_ ? &last_adjoint_ : nullptr;
  }
  ResidualAnswer answer(const MatchTargets& targets,
                        const EvaluationRecord& record);
  void finish_best(EvaluationFields* fields);
  void solve_eigenproblems();
  void estimate_errors();
  void warn();

  const Case& input_;
  StudyStore& store_;
  const StudyOptions& options_;
  Monitor& monitor_;
  Timer timer_;
  std::optional<ForwardModel> model_;
  std::optional<MatchTargets> targets_;
  Eigen::MatrixXd jacobian_;
  std::string phase_ = "start";
  bool with_gradients_ = false;  // the method asks for them, all have them
  VectorX begin_;                // where the optimizers start
  VectorX best_design_;
  RunResult result_;
  // What the last computed evaluation left, so that the best design's meshes
  // need no second evaluation when it came last.
  Evaluation last_;
  EvaluationFields last_fields_;
  AdjointState last_adjoint_;
};

/// The study's method asks for derivatives, and all that it looks at have them.
bool uses_gradients(const Case& input);

/// The design variables as the optimizers want them, from `begin`.
std::vector<Variable> variables_of(const Case& input, const VectorX& begin);

}  // namespace meniscus
