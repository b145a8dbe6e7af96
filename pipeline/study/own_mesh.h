/// Judges what a study found on meshes made for it (internal to run_study()).
/// The mesh of an answer was dragged to it from another design: what is not
/// kept on one of its own is not kept.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/study/study_models.h"
#include "pipeline/study/study_monitor.h"

namespace meniscus::study {

/// The answer of a match or a minimum, or the best design of a sweep; where
/// study.max_evaluations ended it, by one evaluation more. Where a match or a
/// minimum is not kept there, the study goes on from that model, once
/// `hold_margins` has raised what the search is to hold there. `limited` says
/// when there is no time for it. False where no mesh of its own can be made:
/// nothing proves the answer.
bool judge_answer(StudyModels& models, const DeadlineMonitor& limited,
                  const std::function<void()>& hold_margins);

/// Searches again, by `search` on the stage's model, which is frozen at an
/// answer that misses a bound. Where that is only a margin to collapse and a
/// few evaluations find no design that keeps it, the search returns to the
/// model before, which found that answer, and holds its margins above their
/// bounds by what the two models differ in them: two meshes differ by the same
/// in designs that are near each other (an additive correction, as in model
/// management: Alexandrov and Lewis, Optimization and Engineering 2, 2001). The
/// stage is then that model's, or a later one's: true; else the search goes on.
bool search_again(StudyModels& models, const std::function<void()>& search);

/// Puts the best design of which a model was frozen, and that keeps every bound
/// there, in the place of a minimum that does not on a mesh of its own. False
/// where there is nothing to put right, or no such design.
bool return_to_kept(StudyModels& models);

/// An answer that no mesh proves: it is not converged, and says why.
StudyOutcome without_own_mesh(StudyOutcome found);

/// Each point of a front, that of the part last: the others tell how much of
/// the front is the mesh's. Returns what was left out.
std::vector<std::string> judge_front(StudyModels& models,
                                     const DeadlineMonitor& limited);

}  // namespace meniscus::study
