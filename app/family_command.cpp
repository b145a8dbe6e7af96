#include <cstdio>
#include <filesystem>
#include <omp.h>

#include <fmt/format.h>

#include "app/case_input.h"
#include "app/commands.h"
#include "app/exit_code.h"
#include "app/report_file.h"
#include "app/run_files.h"
#include "app/signals.h"
#include "app/study_events.h"
#include "app/versions.h"
#include "core/timer.h"
#include "io/atomic_file.h"
#include "pipeline/family.h"
#include "pipeline/film_frames.h"
#include "pipeline/forward_model.h"
#include "pipeline/walls.h"

namespace meniscus {

namespace {

namespace fs = std::filesystem;

/// The units of the table's responses, those that have one.
std::string units_line(const Case& family) {
  std::string text;
  for (std::size_t k = 0; k < family.responses.size(); ++k) {
    const std::string unit = response_unit(family, static_cast<int>(k));
    if (!unit.empty()) {
      text += fmt::format("{}{} [{}]", text.empty() ? "  units: " : ", ",
                          family.responses[k].name, unit);
    }
  }
  return text.empty() ? text : text + "\n";
}

void explain(const Case& family, const FamilyResult& result,
             const fs::path& folder, bool quiet) {
  const bool good = result.status == RunStatus::Converged;
  if (!good || !quiet) {
    std::fprintf(good ? stdout : stderr, "%s: %s\n", name_of(result.status),
                 result.message.c_str());
  }
  if (quiet) {
    return;
  }
  std::fputs(family_table_text(family_csv(result.rows)).c_str(), stdout);
  std::fputs(units_line(family).c_str(), stdout);
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
                      RunArguments chosen = arguments;
                      chosen.time_limit = 0.0;  // of all members, kept here
                      if (chosen.pictures && late()) {
                        chosen.pictures = false;
                        outcome.warnings.emplace_back(
                            "the family's time limit left no time for "
                            "pictures");
                      }
                      write_run_files(member, fields, place, chosen, monitor,
                                      outcome);
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
    explain(input, result, folder, arguments.common.quiet);
    return exit_code_of(result.status);
  } catch (const IoError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return kExitError;
  }
}

}  // namespace meniscus
