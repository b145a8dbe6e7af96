#include "python/study_run.h"

#include <filesystem>
#include <mutex>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/timer.h"
#include "pipeline/forward/walls.h"
#include "pipeline/results/family.h"
#include "pipeline/results/results.h"
#include "pipeline/results/run_folder.h"
#include "pipeline/study/film_frames.h"
#include "report/output/run_output.h"
#include "report/page/report_page.h"

namespace meniscus::python {

namespace {

namespace fs = std::filesystem;

constexpr const char* kVersions = "meniscus " MENISCUS_VERSION ", from Python";

/// What the options want of the files beside result.json.
RunOutputOptions output_options(const StudyRunOptions& options,
                                Monitor& monitor) {
  return {.pictures = options.pictures,
          .time_limit = options.time_limit,
          .monitor = &monitor};
}

/// The page at the end; what hinders it is a warning, as for the program.
void write_page(const fs::path& folder, const StudyRunOptions& options,
                Monitor& monitor) {
  if (!options.report) {
    return;
  }
  monitor.progress({.stage = "output", .detail = "writing the report page"});
  try {
    for (const std::string& warning :
         write_report(folder, {.versions = kVersions})) {
      monitor.log(Severity::Warning, warning);
    }
  } catch (const Error& error) {
    monitor.log(Severity::Warning,
                std::string("no report page: ") + error.what());
  }
}

void run_members(const Case& input, const StudyRunOptions& options,
                 Monitor& monitor) {
  std::mutex drawing;  // one private display at a time
  const FamilyResult result = run_family(
      input,
      {.folder = options.folder,
       .program_version = MENISCUS_VERSION,
       .resume = options.resume,
       .jobs = options.jobs,
       .threads = options.threads,
       .time_limit = options.time_limit,
       .frames = options.frames ? kMostFrames : 0,
       .monitor = &monitor,
       .write_files = [&](const Case& member, const EvaluationFields& fields,
                          const fs::path& place, RunResult& outcome) {
         const std::lock_guard<std::mutex> guard(drawing);
         RunOutputOptions chosen = output_options(options, monitor);
         chosen.time_limit = 0.0;  // of all members, not of each
         RunOutput(member, place, chosen).finish(fields, outcome);
       }});
  if (result.status == RunStatus::Interrupted) {
    throw Interrupted(result.message);
  }
  for (const FamilyRow& row : result.rows) {
    if (fs::exists(fs::path(options.folder) / row.folder / "result.json")) {
      write_page(fs::path(options.folder) / row.folder, options, monitor);
    }
  }
  write_page(options.folder, options, monitor);
}

void run_alone(const Case& input, const StudyRunOptions& options,
               StudyStore& store, Monitor& monitor) {
  EvaluationFields fields;
  RunOutput output(input, options.folder, output_options(options, monitor));
  RunResult result = run_study(
      input, store,
      {.time_limit = options.time_limit,
       .estimate_errors = options.estimate_errors,
       .frames = options.frames ? kMostFrames : 0,
       .jobs = options.jobs,
       .answered =
           [&](const EvaluationFields& answer) { output.begin(answer); },
       .monitor = &monitor},
      &fields);
  result.warnings.insert(result.warnings.begin(), options.warnings.begin(),
                         options.warnings.end());
  const Timer timer;
  output.finish(fields, result);
  result.output_seconds = timer.seconds();
  result.total_seconds += result.output_seconds;
  write_summary(input, result, store.all(), MENISCUS_VERSION, options.folder);
  write_page(options.folder, options, monitor);
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
    write_page(folder, options, monitor);
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
