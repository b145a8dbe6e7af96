#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/exit_code.h"
#include "app/signals.h"
#include "app/terminal_monitor.h"
#include "app/versions.h"
#include "core/error.h"
#include "pipeline/export_part.h"

namespace meniscus {

int export_command(const ExportArguments& arguments) {
  catch_stop_signals();
  TerminalMonitor monitor({.stop = [] { return stop_signal() != 0; }});
  try {
    const std::filesystem::path file =
        export_part(arguments.run_folder, {.format = arguments.format,
                                           .edge = arguments.edge,
                                           .out = arguments.out,
                                           .program_version = kProgramVersion,
                                           .monitor = &monitor});
    std::printf("%s\n", file.string().c_str());
  } catch (const IoError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kExitWrongInput;
  } catch (const MeshError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kExitNoSolution;
  }
  return kExitDone;
}

}  // namespace meniscus
