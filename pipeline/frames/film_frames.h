/// The films of a study's kept designs: how the part came to its shape.
#pragma once

#include <filesystem>
#include <vector>

#include "core/monitor.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/store/study_store.h"

namespace meniscus::frames {

/// As many films tell a history; more only take time.
inline constexpr int kMostFrames = 24;

struct KeptDesign {
  const store::EvaluationRecord* record = nullptr;
  const char* why = "";  // "start", "better", "best", "looked at"
};

/// Which designs of the case's own model to show, by number of evaluation:
/// the start, each one better than all before it (neighbours for differences
/// left out) and the `best`; of a front the start and its points; of a sweep
/// or a scatter all. Failed ones have no film. When these are more than `most`
/// (>= 2), as many of them, evenly chosen, start and best among them.
std::vector<KeptDesign> kept_designs(
    const case_data::Case& input,
    const std::vector<store::EvaluationRecord>& records, const VectorX& best,
    int most = kMostFrames);

/// Settles the film of each: the same bits as the evaluation's. `model`: the
/// one that evaluated them. One whose film is not found again is left out.
/// Throws Interrupted when the monitor asks to stop.
std::vector<forward::FilmFrame> film_frames(
    const case_data::Case& input, const forward::ForwardModel& model,
    const std::vector<KeptDesign>& designs, Monitor& monitor);

/// FOLDER/frames/film_NNNN.vtp by number of evaluation and, last, the
/// collection FOLDER/frames.pvd with that number as time (docs/results.md).
/// Throws IoError.
void write_frames(const case_data::Case& input,
                  const std::vector<forward::FilmFrame>& frames,
                  const std::filesystem::path& folder);

/// "film_0012.vtp" of evaluation 12.
std::string frame_name(int evaluation);

/// "evaluation 12 (better): foot = 25.3, mass = 0.0119 t": a frame's caption,
/// of the design variables unless they are many, and some responses, the
/// objective first.
std::string frame_caption(const case_data::Case& input,
                          const forward::FilmFrame& frame);

/// From the raw start of a design to its settled film, as it flows and is
/// meshed anew: `evaluation` is the step. `model`: settled there. At most
/// `most` (>= 2), the raw start and the settled film among them.
std::vector<forward::FilmFrame> settling_frames(
    const case_data::EvaluatedCase& inputs, const frozen::FilmModel& model,
    Monitor& monitor, int most = kMostFrames);

/// Removes what write_frames() wrote, also where it was killed, and pictures of
/// it.
void remove_frames(const std::filesystem::path& folder);

}  // namespace meniscus::frames
