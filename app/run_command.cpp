#include <cstdio>
#include <filesystem>
#include <omp.h>
#include <optional>

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
#include "pipeline/results/results.h"
#include "pipeline/results/run_folder.h"
#include "pipeline/study/film_frames.h"
#include "report/output/run_output.h"

namespace meniscus {

namespace {

namespace fs = std::filesystem;

TerminalMonitorOptions options_of(const Case& input,
                                  const CommonArguments& common) {
  TerminalMonitorOptions options = monitor_options(common);
  options.outer_stage = outer_stage_of(input);
  return options;
}

/// One run from the open study to the files.
class Run {
 public:
  Run(const Case& input, StudyStore& store, const RunArguments& arguments,
      fs::path folder)
      : input_(input),
        store_(store),
        arguments_(arguments),
        folder_(std::move(folder)),
        monitor_(options_of(input, arguments.common)),
        output_(input, folder_,
                {.pictures = arguments.pictures,
                 .frame_pictures = arguments.frame_pictures,
                 .exports = arguments.exports,
                 .program_version = kProgramVersion,
                 .time_limit = arguments.time_limit,
                 .monitor = &monitor_}) {}

  int execute(const std::vector<std::string>& warnings);

 private:
  void write_all(RunResult& result, const EvaluationFields& fields);
  int keep(RunStatus status, const std::string& reason);
  void explain(const RunResult& result) const;

  const Case& input_;
  StudyStore& store_;
  const RunArguments& arguments_;
  fs::path folder_;
  TerminalMonitor monitor_;
  RunOutput output_;
};

/// Meshes and pictures first, result.json last: it tells that all is there.
void Run::write_all(RunResult& result, const EvaluationFields& fields) {
  const Timer timer;
  output_.finish(fields, result);
  result.output_seconds = timer.seconds();
  result.total_seconds += result.output_seconds;
  write_summary(input_, result, store_.all(), kProgramVersion, folder_);
  monitor_.tell(end_event(result.status, result.message, result.total_seconds));
}

/// The state of a run that ended early, for people and for --resume.
int Run::keep(RunStatus status, const std::string& reason) {
  const RunResult result =
      kept_result(input_, store_, status, reason, "--resume");
  monitor_.tell(end_event(status, result.message, result.total_seconds));
  std::fprintf(stderr, "%s: %s\n", name_of(status), result.message.c_str());
  write_summary(input_, result, store_.all(), kProgramVersion, folder_);
  report_aloud(folder_, arguments_, monitor_);
  return exit_code_of(status);
}

void Run::explain(const RunResult& result) const {
  const bool good = result.status == RunStatus::Converged;
  if (!good || !arguments_.common.quiet) {
    std::fprintf(good ? stdout : stderr, "%s: %s\n", name_of(result.status),
                 result.message.c_str());
  }
  if (arguments_.common.quiet) {
    return;
  }
  std::fputs(result_text(input_, result).c_str(), stdout);
  std::printf("  results in %s\n", folder_.string().c_str());
  std::fflush(stdout);
  for (const std::string& warning : result.warnings) {
    if (result.message.find(warning) == std::string::npos) {  // told already
      std::fprintf(stderr, "warning: %s\n", warning.c_str());
    }
  }
}

int Run::execute(const std::vector<std::string>& warnings) {
  try {
    EvaluationFields fields;
    RunResult result = run_study(
        input_, store_,
        {.time_limit = arguments_.time_limit,
         .frames = arguments_.frames ? kMostFrames : 0,
         .jobs = arguments_.jobs,
         .listener =
             [this](const StudyNews& news) {
               monitor_.tell(evaluation_event(input_, news));
             },
         .answered =
             [this](const EvaluationFields& answer) { output_.begin(answer); },
         .monitor = &monitor_},
        &fields);
    result.warnings.insert(result.warnings.begin(), warnings.begin(),
                           warnings.end());
    write_all(result, fields);
    report_aloud(folder_, arguments_, monitor_);
    explain(result);
    return exit_code_of(result.status);
  } catch (const Interrupted&) {
    return keep(RunStatus::Interrupted,
                std::string("stopped by ") + name_of_signal(stop_signal()));
  } catch (const IoError& error) {
    // A full disk may well refuse this file too; the study is safe.
    return keep(RunStatus::Error, error.what());
  }
}

}  // namespace

int run_command(const RunArguments& arguments) {
  if (arguments.threads > 0) {
    omp_set_num_threads(arguments.threads);
  }
  const CaseReading reading =
      read_case_aloud(arguments.case_path, arguments.common);
  if (!reading.input) {
    return kExitWrongInput;
  }
  const Case& input = *reading.input;
  if (!input.study.members.empty()) {
    return run_family_command(input, reading.warnings, arguments);
  }
  const fs::path folder = results_folder(input, arguments.common.out);
  catch_stop_signals();
  std::optional<StudyStore> store;
  try {
    refuse_walls(input);
    require_solver(input);
    make_folder(folder);
    store.emplace(open_run(
        input, folder, arguments.resume ? RunBegins::Resumed : RunBegins::Anew,
        kProgramVersion));
  } catch (const IoError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kExitWrongInput;
  }
  return Run(input, *store, arguments, folder).execute(reading.warnings);
}

}  // namespace meniscus
