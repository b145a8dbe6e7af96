#include <cstdio>
#include <filesystem>
#include <omp.h>
#include <optional>

#include "app/case_input.h"
#include "app/commands.h"
#include "app/exit_code.h"
#include "app/signals.h"
#include "app/study_events.h"
#include "app/terminal.h"
#include "app/versions.h"
#include "core/error.h"
#include "pipeline/results/results.h"
#include "pipeline/store/stored_case.h"
#include "report/output/folder_run.h"

namespace meniscus::app {

namespace {

namespace fs = std::filesystem;

output::FolderRunOptions run_options(const RunArguments& arguments,
                                     fs::path folder,
                                     const std::vector<std::string>& warnings) {
  return {.folder = std::move(folder),
          .program_version = kProgramVersion,
          .page_versions = version_text(),
          .resume = arguments.resume,
          .jobs = arguments.jobs,
          .threads = omp_get_max_threads(),
          .time_limit = arguments.time_limit,
          .pictures = arguments.pictures,
          .frames = arguments.frames,
          .frame_pictures = arguments.frame_pictures,
          .report = arguments.report,
          .exports = arguments.exports,
          .warnings = warnings};
}

/// Events for terminal and log, warnings on stderr.
output::FolderRunListener run_listener(const case_data::Case& input,
                                       TerminalMonitor& monitor) {
  return {.monitor = &monitor,
          .evaluated =
              [&](const study::EvaluationEvent& event) {
                monitor.write(evaluation_event(input, event));
              },
          .finished =
              [&](const study::RunResult& result) {
                monitor.write(end_event(result.status, result.message,
                                        result.total_seconds));
              },
          .ended_early =
              [&](const study::RunResult& result) {
                monitor.write(end_event(result.status, result.message,
                                        result.total_seconds));
                std::fprintf(stderr, "%s: %s\n", study::name_of(result.status),
                             result.message.c_str());
              },
          .page_warning = [](const std::string& warning) { warn({warning}); },
          .stop_reason =
              [] {
                return std::string("stopped by ") +
                       name_of_signal(stop_signal());
              }};
}

/// Status and message, on stderr unless all is good; with `quiet` only then.
void explain_end(study::RunStatus status, const std::string& message,
                 bool quiet) {
  const bool good = status == study::RunStatus::Converged;
  if (!good || !quiet) {
    std::fprintf(good ? stdout : stderr, "%s: %s\n", study::name_of(status),
                 message.c_str());
  }
}

void print_result(const case_data::Case& input, const study::RunResult& result,
                  const fs::path& folder, bool quiet) {
  explain_end(result.status, result.message, quiet);
  if (quiet) {
    return;
  }
  std::fputs(results::result_text(input, result).c_str(), stdout);
  std::printf("  results in %s\n", folder.string().c_str());
  std::fflush(stdout);
  for (const std::string& warning : result.warnings) {
    if (result.message.find(warning) == std::string::npos) {  // told already
      warn({warning});
    }
  }
}

void print_result(const results::FamilyResult& result,
                  const output::FolderRunOptions& options, bool quiet) {
  explain_end(result.status, result.message, quiet);
  if (quiet) {
    return;
  }
  std::fputs(results::family_table_text(results::family_csv(result.rows),
                                        store::stored_units(options.folder))
                 .c_str(),
             stdout);
  std::printf("  %zu members in %.1f s\n  results in %s\n", result.rows.size(),
              result.total_seconds, options.folder.string().c_str());
  std::fflush(stdout);
  warn(options.warnings);
  warn(result.warnings);
}

int run_one(const case_data::Case& input,
            const output::FolderRunOptions& options, bool quiet,
            TerminalMonitorOptions monitor_options) {
  std::optional<output::FolderRun> run;
  const int refused = exit_code_of({on<IoError>(kExitWrongInput)}, [&] {
    run.emplace(input, options);
    return kExitDone;
  });
  if (refused != kExitDone) {
    return refused;
  }
  monitor_options.outer_stage = outer_stage_of(input);
  TerminalMonitor monitor(std::move(monitor_options));
  const output::FolderRunResult end = run->run(run_listener(input, monitor));
  if (!end.error) {
    print_result(input, end.result, options.folder, quiet);
  }
  return exit_code_of(end.result.status);
}

int run_members(const case_data::Case& input,
                const output::FolderRunOptions& options, bool quiet,
                TerminalMonitorOptions monitor_options) {
  monitor_options.outer_stage = "family";
  TerminalMonitor monitor(std::move(monitor_options));
  const int refused = exit_code_of({on<IoError>(kExitWrongInput)}, [&] {
    output::prepare_run_folder(input, options.folder);
    fs::remove(options.folder / "report.html");
    return kExitDone;
  });
  if (refused != kExitDone) {
    return refused;
  }
  const output::FolderRunListener listener = run_listener(input, monitor);
  const results::FamilyResult result =
      output::run_family_into_folder(input, options, listener);
  output::write_family_pages(result, options, listener);
  monitor.write(end_event(result.status, result.message, result.total_seconds));
  print_result(result, options, quiet);
  return exit_code_of(result.status);
}

}  // namespace

int run_command(const RunArguments& arguments) {
  const CommonArguments& common = arguments.common;
  const reader::CaseReading reading =
      read_and_report_case(arguments.case_path, common);
  if (!reading.input) {
    return kExitWrongInput;
  }
  const case_data::Case& input = *reading.input;
  const output::FolderRunOptions options = run_options(
      arguments, results_folder(input, common.out), reading.warnings);
  catch_stop_signals();
  const auto run = input.study.members.empty() ? run_one : run_members;
  return run(input, options, common.quiet, monitor_options(common));
}

}  // namespace meniscus::app
