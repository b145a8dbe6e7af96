#include "app/run_files.h"

#include <mutex>

#include <fmt/format.h>

#include "app/draw.h"
#include "app/exit_code.h"
#include "app/versions.h"
#include "core/error.h"
#include "core/timer.h"
#include "pipeline/export_part.h"
#include "pipeline/film_frames.h"
#include "pipeline/results.h"

namespace meniscus {

namespace {

void draw_all(const Case& input, const EvaluationFields& fields,
              const std::filesystem::path& folder,
              const RunArguments& arguments, Monitor& monitor,
              RunResult& result) {
  static std::mutex drawing;  // one private display at a time
  const std::lock_guard<std::mutex> guard(drawing);
  monitor.progress({.stage = "output", .detail = "drawing pictures"});
  std::vector<std::string> warnings = draw(input, fields, folder, monitor);
  if (arguments.frame_pictures && !fields.history.empty()) {
    std::vector<std::string> captions;
    captions.reserve(fields.history.size());
    for (const FilmFrame& frame : fields.history) {
      captions.push_back(frame_caption(input, frame));
    }
    std::vector<std::string> solids;
    for (const CapSpec& cap : fields.inputs.film_system.caps) {
      solids.push_back(cap.name);
    }
    for (std::string& warning : draw_frames(input.title, solids, fields.history,
                                            captions, folder, monitor)) {
      warnings.push_back(std::move(warning));
    }
  }
  for (std::string& warning : warnings) {
    result.warnings.push_back(std::move(warning));
  }
}

/// The answer in the formats asked for: as `meniscus export` writes it. What
/// does not work out is a warning.
void export_all(const std::filesystem::path& folder,
                const RunArguments& arguments, Monitor& monitor,
                RunResult& result) {
  // OpenCASCADE keeps global state; members of a family come side by side.
  static std::mutex one_at_a_time;
  for (const std::string& format : arguments.exports) {
    monitor.progress({.stage = "output", .detail = "writing " + format});
    try {
      const std::lock_guard<std::mutex> guard(one_at_a_time);
      export_part(folder, {.format = format,
                           .program_version = kProgramVersion,
                           .monitor = &monitor});
    } catch (const Interrupted&) {
      throw;
    } catch (const IoError&) {
      throw;
    } catch (const Error& error) {
      result.warnings.push_back(
          fmt::format("not written as {}: {}", format, error.what()));
    }
  }
}

}  // namespace

void write_run_files(const Case& input, const EvaluationFields& fields,
                     const std::filesystem::path& folder,
                     const RunArguments& arguments, Monitor& monitor,
                     RunResult& result) {
  const Timer timer;
  if (!fields.mesh.nodes.empty()) {
    monitor.progress({.stage = "output", .detail = "writing meshes"});
    write_meshes(input, fields, folder);
    write_frames(input, fields.history, folder);
    export_all(folder, arguments, monitor, result);
    const bool late = arguments.time_limit > 0.0 &&
                      result.total_seconds >= arguments.time_limit;
    if (arguments.pictures && late) {
      result.warnings.push_back(
          fmt::format("the time limit of {:g} s left no time for pictures",
                      arguments.time_limit));
    } else if (arguments.pictures) {
      draw_all(input, fields, folder, arguments, monitor, result);
    }
  }
  if (result.best && !fields.mesh.nodes.empty()) {
    result.output_seconds = timer.seconds();
    result.ledger = make_ledger(input, result, fields, folder);
  }
  for (const std::string& name : write_unfilled(fields, folder)) {
    result.warnings.push_back("look at the surface in " + name);
  }
}

int exit_code_of(RunStatus status) {
  switch (status) {
    case RunStatus::Converged:
      return kExitDone;
    case RunStatus::Infeasible:
    case RunStatus::Stopped:
    case RunStatus::Failed:
      return kExitNoSolution;
    case RunStatus::Error:
      return kExitError;
    case RunStatus::Interrupted:
      return kExitInterrupted;
  }
  return kExitError;
}

}  // namespace meniscus
