#include "python/study_run.h"

#include <filesystem>

#include <fmt/format.h>

#include "core/error.h"
#include "core/timer.h"
#include "io/atomic_file.h"
#include "pipeline/family.h"
#include "pipeline/results.h"
#include "pipeline/run_folder.h"
#include "pipeline/walls.h"

namespace meniscus::python {

namespace {

namespace fs = std::filesystem;

void write_fields(const Case& input, const EvaluationFields& fields,
                  const fs::path& folder, RunResult& result) {
  if (!fields.mesh.nodes.empty()) {
    write_meshes(input, fields, folder);
  }
  for (const std::string& name : write_unfilled(fields, folder)) {
    result.warnings.push_back("look at the surface in " + name);
  }
}

void run_members(const Case& input, const StudyRunOptions& options,
                 Monitor& monitor) {
  const FamilyResult result =
      run_family(input, {.folder = options.folder,
                         .program_version = MENISCUS_VERSION,
                         .resume = options.resume,
                         .jobs = options.jobs,
                         .threads = options.threads,
                         .time_limit = options.time_limit,
                         .monitor = &monitor,
                         .write_files = &write_fields});
  if (result.status == RunStatus::Interrupted) {
    throw Interrupted(result.message);
  }
}

void run_alone(const Case& input, const StudyRunOptions& options,
               StudyStore& store, Monitor& monitor) {
  EvaluationFields fields;
  RunResult result = run_study(input, store,
                               {.time_limit = options.time_limit,
                                .estimate_errors = options.estimate_errors,
                                .jobs = options.jobs,
                                .monitor = &monitor},
                               &fields);
  result.warnings.insert(result.warnings.begin(), options.warnings.begin(),
                         options.warnings.end());
  const Timer timer;
  monitor.progress({.stage = "output", .detail = "writing meshes"});
  write_fields(input, fields, options.folder, result);
  result.output_seconds = timer.seconds();
  result.total_seconds += result.output_seconds;
  write_summary(input, result, store.all(), MENISCUS_VERSION, options.folder);
}

}  // namespace

void run_into_folder(const Case& input, const StudyRunOptions& options,
                     Monitor& monitor) {
  const fs::path folder = options.folder;
  refuse_walls(input);
  require_solver(input);
  make_folder(folder);
  if (!input.study.members.empty()) {
    run_members(input, options, monitor);
    return;
  }
  StudyStore store = open_run(
      input, folder, options.resume ? RunBegins::Resumed : RunBegins::Anew,
      MENISCUS_VERSION);
  const auto keep = [&](RunStatus status, const std::string& reason) {
    write_summary(input, kept_result(input, store, status, reason, "resume"),
                  store.all(), MENISCUS_VERSION, folder);
  };
  try {
    run_alone(input, options, store, monitor);
  } catch (const Interrupted&) {
    keep(RunStatus::Interrupted, "stopped on request");
    throw;
  } catch (const IoError& error) {
    keep(RunStatus::Error, error.what());
    throw;
  }
}

}  // namespace meniscus::python
