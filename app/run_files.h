/// The files of a finished run beside its result.json.
#pragma once

#include <filesystem>
#include <string>

#include "app/commands.h"
#include "core/monitor.h"
#include "pipeline/forward_model.h"
#include "pipeline/study.h"

namespace meniscus {

/// Meshes of the best design, pictures where `arguments` want them, or the
/// surface that could not be filled; warnings go to `result`. Throws IoError.
void write_run_files(const Case& input, const EvaluationFields& fields,
                     const std::filesystem::path& folder,
                     const RunArguments& arguments, Monitor& monitor,
                     RunResult& result);

/// Of result.json's status.
int exit_code_of(RunStatus status);

}  // namespace meniscus
