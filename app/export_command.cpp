#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/exit_code.h"
#include "app/signals.h"
#include "app/terminal_monitor.h"
#include "app/versions.h"
#include "core/error.h"
#include "pipeline/results/export_part.h"
#include "pipeline/store/find_runs.h"

namespace meniscus::app {

namespace {

namespace fs = std::filesystem;

/// One run; what goes wrong with it is told. Returns the exit code.
int export_run(const fs::path& run, const results::ExportOptions& options) {
  const std::string prefix = run.string() + ": ";
  return exit_code_of(
      {on<IoError>(kExitWrongInput), on<InvalidInput>(kExitWrongInput, prefix),
       on<MeshError>(kExitNoSolution, prefix),
       on<SolverError>(kExitNoSolution, prefix)},
      [&] {
        const fs::path file = results::export_part(run, options);
        std::printf("%s\n", file.string().c_str());
        return kExitDone;
      });
}

}  // namespace

int export_command(const ExportArguments& arguments) {
  catch_stop_signals();
  TerminalMonitor monitor({.stop = [] { return stop_signal() != 0; }});
  const fs::path folder = arguments.run_folder;
  std::vector<fs::path> runs;
  const int no_runs = exit_code_of({on<IoError>(kExitWrongInput)}, [&] {
    runs = store::runs_in(folder);
    return kExitDone;
  });
  if (no_runs != kExitDone) {
    return no_runs;
  }
  if (!arguments.out.empty() && runs.front() != folder) {
    throw InvalidInput(fmt::format(
        "{} is a family, whose {} members are written into their folders; "
        "--out takes one of them: give {}",
        folder.string(), runs.size(), runs.front().string()));
  }
  int code = kExitDone;
  for (const fs::path& run : runs) {
    // The worst that a member came to; the others are written all the same.
    code = std::max(code, export_run(run, {.format = arguments.format,
                                           .edge = arguments.edge,
                                           .out = arguments.out,
                                           .program_version = kProgramVersion,
                                           .monitor = &monitor}));
  }
  return code;
}

}  // namespace meniscus::app
