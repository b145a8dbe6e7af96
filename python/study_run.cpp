#include "python/study_run.h"

#include <filesystem>

#include <fmt/format.h>

#include "core/error.h"
#include "core/timer.h"
#include "io/atomic_file.h"
#include "pipeline/family.h"
#include "pipeline/results.h"
#include "pipeline/stored_case.h"
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

/// The state of a run that ended early, for readers and for resume.
void keep(const Case& input, const StudyStore& store, RunStatus status,
          const std::string& reason, const fs::path& folder) {
  RunResult result = result_so_far(input, store.all());
  result.status = status;
  result.message =
      fmt::format("{}; {} finished evaluation{} kept, go on with resume",
                  reason, store.size(), store.size() == 1 ? " is" : "s are");
  write_summary(input, result, store.all(), MENISCUS_VERSION, folder);
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
  const StudyMeta meta{.program_version = MENISCUS_VERSION,
                       .case_hash = input.hash,
                       .case_text = stored_case(input)};
  StudyStore store = options.resume ? StudyStore::resume(options.folder, meta)
                                    : StudyStore::start(options.folder, meta);
  remove_leftovers(folder);
  // An older result must not stand beside a study that is not its own.
  std::error_code ignored;
  fs::remove(folder / "result.json", ignored);
  fs::remove(folder / "family.csv", ignored);
  try {
    run_alone(input, options, store, monitor);
  } catch (const Interrupted&) {
    keep(input, store, RunStatus::Interrupted, "stopped on request", folder);
    throw;
  } catch (const IoError& error) {
    keep(input, store, RunStatus::Error, error.what(), folder);
    throw;
  }
}

}  // namespace meniscus::python
