#include <cstdio>
#include <filesystem>
#include <mutex>
#include <omp.h>

#include <fmt/format.h>

#include "app/case_input.h"
#include "app/commands.h"
#include "app/exit_code.h"
#include "app/report_file.h"
#include "app/signals.h"
#include "app/study_events.h"
#include "app/versions.h"
#include "core/atomic_file.h"
#include "core/timer.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/walls.h"
#include "pipeline/results/family.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/film_frames.h"
#include "report/output/run_output.h"

namespace meniscus {

namespace {

namespace fs = std::filesystem;

void explain(const FamilyResult& result, const fs::path& folder, bool quiet) {
  const bool good = result.status == RunStatus::Converged;
  if (!good || !quiet) {
    std::fprintf(good ? stdout : stderr, "%s: %s\n", name_of(result.status),
                 result.message.c_str());
  }
  if (quiet) {
    return;
  }
  std::fputs(
      family_table_text(family_csv(result.rows), stored_units(folder)).c_str(),
      stdout);
  std::printf("  %zu members in %.1f s\n  results in %s\n", result.rows.size(),
              result.total_seconds, folder.string().c_str());
  std::fflush(stdout);
  for (const std::string& warning : result.warnings) {
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
}

}  // namespace

int run_family_command(const Case& input,
                       const std::vector<std::string>& warnings,
                       const RunArguments& arguments) {
  const fs::path folder = results_folder(input, arguments.common.out);
  catch_stop_signals();
  TerminalMonitorOptions options = monitor_options(arguments.common);
  options.outer_stage = "family";
  TerminalMonitor monitor(std::move(options));
  try {
    refuse_walls(input);
    require_solver(input);
    make_folder(folder);
    fs::remove(folder / "report.html");
  } catch (const IoError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kExitWrongInput;
  }
  std::mutex writing;  // one private display, one CAD kernel at a time
  const Timer timer;
  const auto late = [&] {
    return arguments.time_limit > 0.0 &&
           timer.seconds() >= arguments.time_limit;
  };
  try {
    FamilyResult result = run_family(
        input, {.folder = folder,
                .program_version = kProgramVersion,
                .resume = arguments.resume,
                .jobs = arguments.jobs,
                .threads = omp_get_max_threads(),
                .time_limit = arguments.time_limit,
                .frames = arguments.frames ? kMostFrames : 0,
                .listener =
                    [&](const StudyNews& news) {
                      monitor.tell(evaluation_event(input, news));
                    },
                .monitor = &monitor,
                .write_files =
                    [&](const Case& member, const EvaluationFields& fields,
                        const fs::path& place, RunResult& outcome) {
                      const std::lock_guard<std::mutex> guard(writing);
                      RunOutputOptions chosen{
                          .pictures = arguments.pictures,
                          .frame_pictures = arguments.frame_pictures,
                          .exports = arguments.exports,
                          .program_version = kProgramVersion,
                          .monitor = &monitor};
                      if (chosen.pictures && late()) {
                        chosen.pictures = false;
                        outcome.warnings.emplace_back(
                            "the family's time limit left no time for "
                            "pictures");
                      }
                      RunOutput(member, place, chosen).finish(fields, outcome);
                    }});
    result.warnings.insert(result.warnings.begin(), warnings.begin(),
                           warnings.end());
    for (const FamilyRow& row : result.rows) {
      if (fs::exists(folder / row.folder / "result.json")) {
        report_aloud(folder / row.folder, arguments, monitor);
      }
    }
    report_aloud(folder, arguments, monitor);
    monitor.tell(
        end_event(result.status, result.message, result.total_seconds));
    explain(result, folder, arguments.common.quiet);
    return exit_code_of(result.status);
  } catch (const IoError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return kExitError;
  }
}

}  // namespace meniscus
