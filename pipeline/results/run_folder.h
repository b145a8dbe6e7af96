/// A run's folder when a study begins in it, and what is said of one that ended
/// early.
#pragma once

#include <filesystem>
#include <string>

#include "pipeline/store/study_store.h"
#include "pipeline/study/study.h"

namespace meniscus::results {

enum class RunBegins { Anew, Resumed };

/// Opens the study of `input` in the folder, which must be there, and removes
/// what an earlier run left that would stand beside a study not its own: half
/// files of killed runs, result.json, the family's table, frames, the page, and
/// all that it owned (run_files.h): meshes, findings, pictures, exports.
/// Throws IoError as StudyStore does.
store::StudyStore open_run(const case_data::Case& input,
                           const std::filesystem::path& folder,
                           RunBegins begins,
                           const std::string& program_version);

/// The state of a run that ended early for `reason`, for readers; `go_on`: how
/// it goes on, "--resume".
study::RunResult partial_result(const case_data::Case& input,
                                const store::StudyStore& store,
                                study::RunStatus status,
                                const std::string& reason,
                                const std::string& go_on);

}  // namespace meniscus::results
