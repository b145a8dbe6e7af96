#include <cstdio>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "app/case_input.h"
#include "app/commands.h"
#include "app/exit_code.h"
#include "app/signals.h"
#include "app/terminal_monitor.h"
#include "app/versions.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/units.h"
#include "pipeline/decks/solve_deck.h"

namespace meniscus::app {

namespace {

namespace fs = std::filesystem;

int solve(const SolveArguments& arguments, Monitor& monitor) {
  const fs::path path = arguments.path;
  std::optional<UnitSystem> units;
  if (!arguments.units.empty()) {
    units = unit_system(arguments.units);
  }
  decks::DeckPart part = decks::read_deck_part(path);
  const fs::path folder =
      folder_without_run(path.stem().string(), arguments.common.out, "_deck");
  make_folder(folder);
  decks::DeckResult result = decks::solve_deck(std::move(part), &monitor);
  if (result.title.empty()) {
    result.title = path.filename().string();
  }
  decks::write_deck_result(result, units, kProgramVersion, folder);
  if (!arguments.common.quiet) {
    std::fputs(decks::deck_text(result, units).c_str(), stdout);
    std::printf("  written to %s\n", folder.string().c_str());
  }
  return kExitDone;
}

}  // namespace

int solve_command(const SolveArguments& arguments) {
  catch_stop_signals();
  TerminalMonitor monitor(monitor_options(arguments.common));
  return exit_code_of(
      {on<IoError>(kExitWrongInput), on<MeshError>(kExitNoSolution),
       on<SolverError>(kExitNoSolution)},
      [&] { return solve(arguments, monitor); });
}

}  // namespace meniscus::app
