#include <algorithm>
#include <chrono>
#include <cstdio>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/exit_code.h"
#include "app/terminal.h"
#include "core/error.h"
#include "pipeline/results/study_watch.h"

namespace meniscus::app {

namespace {

constexpr auto kRefresh = std::chrono::seconds(1);

std::string header_text(const results::StudyStatus& status) {
  return fmt::format(
      "{}{}\n", status.title.empty() ? "" : status.title + ": ",
      status.at_work ? "running (" + status.holder + ")" : "no run is at work");
}

/// Draws over what it drew before.
class Screen {
 public:
  void show(const std::string& text) {
    if (lines_ > 0) {
      std::printf("\x1b[%dA\x1b[J", lines_);
    }
    lines_ = 0;
    std::istringstream rest(text);
    for (std::string line; std::getline(rest, line); ++lines_) {
      std::puts(truncate_to(line, columns_of(stdout) - 1).c_str());
    }
    std::fflush(stdout);
  }

 private:
  int lines_ = 0;
};

int exit_code_of_status(const std::string& status) {
  for (const study::RunStatus known :
       {study::RunStatus::Converged, study::RunStatus::Infeasible,
        study::RunStatus::Stopped, study::RunStatus::Failed,
        study::RunStatus::Error, study::RunStatus::Interrupted}) {
    if (status == study::name_of(known)) {
      return exit_code_of(known);
    }
  }
  return kExitError;
}

int print_end(const results::StudyStatus& status) {
  if (status.status.empty()) {
    std::printf(
        "the run has ended without a result: it was killed or never began to "
        "write one; go on with 'meniscus run CASE --resume'\n");
  } else {
    std::printf("%s: %s\n", status.status.c_str(), status.message.c_str());
  }
  std::fflush(stdout);
  return exit_code_of_status(status.status);
}

int watch(const WatchArguments& arguments) {
  results::StudyWatch study(arguments.folder);
  const bool redraws = is_terminal(stdout) && !arguments.once;
  Screen screen;
  bool first = true;
  while (true) {
    const results::StudyStatus status = study.poll();
    if (redraws) {
      screen.show(header_text(status) + status.text);
    } else if (arguments.once) {
      std::fputs((header_text(status) + status.text).c_str(), stdout);
    } else {
      if (first) {
        std::fputs(header_text(status).c_str(), stdout);
      }
      for (const std::string& line : status.new_lines) {
        std::puts(line.c_str());
      }
    }
    std::fflush(stdout);
    first = false;
    if (!status.at_work) {
      return print_end(status);
    }
    if (arguments.once) {
      return kExitDone;
    }
    std::this_thread::sleep_for(kRefresh);
  }
}

}  // namespace

int study_watch_command(const WatchArguments& arguments) {
  return exit_code_of({on<IoError>(kExitWrongInput)},
                      [&] { return watch(arguments); });
}

}  // namespace meniscus::app
