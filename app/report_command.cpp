#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/exit_code.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "app/terminal_monitor.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/worst_cases.h"
#include "pipeline/results/run_files.h"
#include "pipeline/store/stored_case.h"
#include "report/output/run_pictures.h"
#include "report/page/report_page.h"
#include "report/picture/renderer.h"

namespace meniscus::app {

namespace {

namespace fs = std::filesystem;

/// An empty object where there is none.
nlohmann::ordered_json stored_result(const fs::path& folder) {
  const fs::path file = folder / "result.json";
  auto result = fs::exists(file) ? parse_json(read_file(file))
                                 : nlohmann::ordered_json::object();
  return result.is_object() ? result : nlohmann::ordered_json::object();
}

/// The pictures again, of the answer whose meshes stand in the folder.
void redraw_pictures(const fs::path& folder, Monitor& monitor) {
  if (!fs::exists(folder / "part_surface.vtp") ||
      !fs::exists(folder / "study.sqlite")) {
    return;
  }
  const store::StudyStore store = store::StudyStore::read(folder.string());
  const case_data::Case input = store::restore_case(store.meta());
  case_data::EvaluatedCase inputs = case_data::evaluate(
      input, store::answer_of_run(input, store.all(), folder));
  const nlohmann::ordered_json result = stored_result(folder);
  forward::add_worst_cases(input, result, inputs);
  const std::vector<picture::PictureJob> jobs = output::stored_run_pictures(
      input, inputs, result.value("worst_load_case", ""), folder);
  std::vector<std::string> names;
  names.reserve(jobs.size());
  for (const picture::PictureJob& job : jobs) {
    names.push_back(fs::path(job.output).filename().string());
  }
  results::claim_files(folder, names);
  warn(picture::render_pictures(jobs, {.monitor = &monitor}));
}

}  // namespace

int report_command(const ReportArguments& arguments) {
  catch_stop_signals();
  TerminalMonitor monitor({.stop = [] { return stop_signal() != 0; }});
  const fs::path folder = arguments.folder;
  const int refused = exit_code_of({on<IoError>(kExitWrongInput)}, [&] {
    warn(page::write_report(folder, {.versions = version_text()}));
    if (arguments.pictures) {
      redraw_pictures(folder, monitor);
    }
    return kExitDone;
  });
  if (refused != kExitDone) {
    return refused;
  }
  if (fs::exists(folder / "report.html")) {
    std::printf("%s\n", (folder / "report.html").c_str());
  }
  return kExitDone;
}

}  // namespace meniscus::app
