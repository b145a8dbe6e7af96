#include "report/picture.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "core/child_process.h"
#include "core/error.h"
#include "core/find_program.h"

namespace meniscus {

namespace {

constexpr const char* kHelper = "meniscus-render";
constexpr const char* kHelperVariable = "MENISCUS_RENDER";
constexpr double kDisplayStart = 15.0;  // [s], a busy machine included

/// A display for the helper: a virtual one of our own, else the user's.
struct Display {
  std::unique_ptr<BackgroundChild> server;
  std::string name;     // ":7"; empty: none
  std::string problem;  // then why
};

Display open_display() {
  Display display;
  const char* own = std::getenv("DISPLAY");
  if (!find_program("Xvfb")) {
    display.problem = "Xvfb is not installed (Debian package xvfb)";
  } else {
    ChildOptions options;
    // The server picks a free number and prints it when it is ready.
    options.argv = {"Xvfb",         "-displayfd", "1",   "-screen", "0",
                    "1280x1024x24", "-nolisten",  "tcp", "-noreset"};
    try {
      display.server = std::make_unique<BackgroundChild>(options);
      const auto line = display.server->read_line(kDisplayStart);
      if (line && !line->empty() &&
          std::isdigit(static_cast<unsigned char>(line->front())) != 0) {
        display.name = ":" + *line;
        return display;
      }
      display.problem = "Xvfb did not start";
    } catch (const Error& error) {
      display.problem = error.what();
    }
    display.server.reset();
  }
  if (own != nullptr && *own != '\0') {
    display.name = own;
  }
  return display;
}

std::string last_lines(const std::string& text) {
  std::string line = text;
  while (!line.empty() &&
         std::isspace(static_cast<unsigned char>(line.back())) != 0) {
    line.pop_back();
  }
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

std::string render_with(const std::string& helper, const Display& display,
                        const std::vector<PictureJob>& jobs,
                        const PictureOptions& options) {
  const std::string input = to_json(jobs);
  ChildOptions child;
  child.argv = {helper};
  child.input = input;
  child.time_limit = options.time_limit;
  child.error_tail = 1000;
  child.monitor = options.monitor;
  child.environment = {{"DISPLAY", display.name}};
  // Mesa's cache of compiled shaders halves a picture's time; without a home
  // folder it has no place and would complain.
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') {
    child.environment.emplace_back("MESA_SHADER_CACHE_DISABLE", "true");
  }
  if (display.server) {
    child.environment.emplace_back("LIBGL_ALWAYS_SOFTWARE", "1");
    child.environment.emplace_back("XAUTHORITY", std::nullopt);
  }
  const ChildResult result = run_child(child);
  if (result.stopped) {
    throw Interrupted("stopped on request during pictures");
  }
  if (result.succeeded()) {
    return "";
  }
  return fmt::format("pictures are missing or incomplete: {} {}{}{}", kHelper,
                     describe_end(result),
                     result.error_tail.empty() ? "" : ": ",
                     last_lines(result.error_tail));
}

}  // namespace

std::vector<std::string> render_pictures(const std::vector<PictureJob>& jobs,
                                         const PictureOptions& options) {
  if (jobs.empty()) {
    return {};
  }
  auto helper = find_helper(kHelper, kHelperVariable);
  const char* set = std::getenv(kHelperVariable);
  if (!helper && (set == nullptr || *set == '\0')) {
    helper =
        find_program(fmt::format("{}/{}", MENISCUS_HELPER_FOLDER, kHelper));
  }
  if (!helper) {
    return {fmt::format(
        "no pictures: the helper program {} is neither beside this program, "
        "nor in ../libexec/meniscus, nor in {}; set {} to its path",
        kHelper, MENISCUS_HELPER_FOLDER, kHelperVariable)};
  }
  std::string warning;
  try {
    const Display display = open_display();
    if (display.name.empty()) {
      return {fmt::format("no pictures: there is no display and {}",
                          display.problem)};
    }
    warning = render_with(helper->string(), display, jobs, options);
  } catch (const IoError& error) {
    warning = fmt::format("no pictures: {}", error.what());
  }
  return warning.empty() ? std::vector<std::string>{}
                         : std::vector<std::string>{warning};
}

}  // namespace meniscus
