/// New frozen models on a study's way: when, where, and how its database names
/// them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/case_data/case.h"
#include "pipeline/store/study_store.h"

namespace meniscus::store {

/// A model frozen at a design that the one before has evaluated.
struct Refreeze {
  int evaluation = 0;  // of that design, in the database
  VectorX design;
  std::string reason;  // in words
  VectorX shift;       // responses there, the new model's less those of the one
                       // before: what another mesh changes
  VectorX responses;   // of the model before, there
  std::optional<VectorX> go_on_from = {};  // the best design, where the model
                                           // is frozen at another
};

inline constexpr int kMostRefreezes = 10;

/// How the database names a model: "frozen at evaluation 12".
std::string refrozen_model(int evaluation);

/// That of a sweep's designs at which films join in another way:
/// "joined at evaluation 12". It answers for them alone.
std::string rejoined_model(int evaluation);

/// Of the case's own resolution: the first model, or one frozen later.
bool is_study_model(const std::string& model);

/// Number of records of one model.
int count_of_model(const std::vector<EvaluationRecord>& records,
                   const std::string& model);

/// The last of these models to begin that is no rejoined one; kStudyModel when
/// none has evaluated a design. `answer`: of those that have evaluated it.
std::string answering_model(const std::vector<EvaluationRecord>& records,
                            const std::optional<VectorX>& answer = {});

/// The largest difference of a variable, x its range.
double design_distance(const case_data::Case& input, const VectorX& a,
                       const VectorX& b);

/// The case whose freeze is the model that a run's answer is of, with all
/// before it.
case_data::Case frozen_as_answered(case_data::Case input,
                                   const std::vector<EvaluationRecord>& records,
                                   const VectorX& answer);

/// What a study on one model has come to.
struct FrozenStage {
  const case_data::Case& input;           // frozen at its initial design
  std::vector<EvaluationRecord> records;  // designs asked for
  const std::string& model;
  const VectorX& best;            // of the model's evaluated designs
  double min_dihedral_deg = 0.0;  // of the freeze
  bool converged = false;
};

/// Whether a design failed because of its distance from the model's: its
/// elements invert, a fillet's ball finds no room in its bands, the solver does
/// not converge, or, though it is close to `best`, the film is not found.
bool is_beyond_reach(const case_data::Case& input,
                     const EvaluationRecord& record, const VectorX& best);

/// Designs beyond reach, after which a search is ended early for a new model.
inline constexpr int kMostBeyond = 6;

/// Of the records that failed because films join in another way the one nearest
/// to `best`, within a quarter of the ranges.
std::optional<EvaluationRecord> rejoined_beside(
    const case_data::Case& input, const std::vector<EvaluationRecord>& records,
    const VectorX& best);

/// Where the study should go on with a new model, shift not filled in: at its
/// best design when the elements there have become flat, when so many designs
/// were beyond reach, or when the search ended beside some that were. Where the
/// model is frozen at that very design the new one is frozen at the design that
/// answered nearest to those beyond, and the study goes on from its best.
/// Nothing where no other design has answered.
std::optional<Refreeze> find_refreeze(const FrozenStage& stage);

}  // namespace meniscus::store
