#include "report/picture/picture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <sys/random.h>

#include "core/atomic_file.h"
#include "core/child_process.h"
#include "core/error.h"
#include "core/find_program.h"

namespace meniscus::picture {

namespace fs = std::filesystem;

namespace {

constexpr const char* kHelper = "meniscus-render";
constexpr const char* kHelperVariable = "MENISCUS_RENDER";
constexpr double kDisplayStart = 15.0;  // [s], a busy machine included
// Beside the caller's work: a third of its share of a processor that both
// want, and time enough for that.
constexpr int kNiceness = 5;
constexpr double kTimeBeside = 600.0;  // [s]

/// A folder that nobody else may look into: for the display's key, and for the
/// renderer's compiled shaders (a sixth of the time of three pictures).
class PrivateFolder {
 public:
  PrivateFolder() {
    std::error_code failed;
    std::string name =
        (fs::temp_directory_path(failed) / "meniscus-XXXXXX").string();
    if (!failed && mkdtemp(name.data()) != nullptr) {
      path_ = name;
    }
  }
  ~PrivateFolder() {
    std::error_code ignored;
    if (!path_.empty()) {
      fs::remove_all(path_, ignored);
    }
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  /// Empty where there is none.
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Where the renderer keeps its shaders; nowhere where there is no folder.
std::pair<std::string, std::optional<std::string>> shader_variable(
    const PrivateFolder& folder) {
  using Variable = std::pair<std::string, std::optional<std::string>>;
  return folder.path().empty()
             ? Variable("MESA_SHADER_CACHE_DISABLE", "true")
             : Variable("MESA_SHADER_CACHE_DIR", folder.path().string());
}

/// A key of X for any display and host (Xau's format: family, then address,
/// display, kind and key, each behind its length in two bytes, high one first);
/// false where it cannot be written.
bool write_display_key(const fs::path& file) {
  std::array<char, 16> key;
  if (::getrandom(key.data(), key.size(), 0) !=
      static_cast<ssize_t>(key.size())) {
    return false;
  }
  constexpr std::string_view kKind = "MIT-MAGIC-COOKIE-1";
  std::string bytes("\xff\xff\0\0\0\0", 6);  // any family, no address, any
  for (const std::string_view part :
       {kKind, std::string_view(key.data(), key.size())}) {
    bytes += '\0';
    bytes += static_cast<char>(part.size());
    bytes += part;
  }
  try {
    write_file(file, bytes);
    return true;
  } catch (const IoError&) {
    return false;
  }
}

/// A display for the helper: a virtual one of our own, else the user's.
struct Display {
  std::unique_ptr<BackgroundChild> server;
  fs::path key;         // of the server: who has it may look and draw
  std::string name;     // ":7"; empty: none
  std::string problem;  // then why
};

Display open_display(const PrivateFolder& folder, int niceness) {
  Display display;
  display.key = folder.path() / "key";
  const char* own = std::getenv("DISPLAY");
  if (!find_program("Xvfb")) {
    display.problem = "Xvfb is not installed (Debian package xvfb)";
  } else if (folder.path().empty() || !write_display_key(display.key)) {
    display.problem =
        "a display's key cannot be written: there is no folder for temporary "
        "files (TMPDIR)";
  } else {
    ChildOptions options;
    options.niceness = niceness;
    // The server picks a free number and prints it when it is ready.
    options.argv = {"Xvfb",     "-displayfd", "1",         "-screen",
                    "0",        "64x64x24",   "-nolisten", "tcp",
                    "-noreset", "-auth",      display.key};
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
                        const PrivateFolder& folder,
                        const std::vector<PictureJob>& jobs,
                        const PictureOptions& options) {
  const std::string input = to_bytes(jobs);
  ChildOptions child;
  child.argv = {helper};
  child.input = input;
  child.time_limit = options.time_limit;
  child.error_tail = 1000;
  child.niceness = options.niceness;
  child.monitor = options.monitor;
  child.environment = {{"DISPLAY", display.name},
                       // No home folder is needed, nothing is left in it; but
                       // what one picture compiled serves the next.
                       shader_variable(folder),
                       // Pictures' memory is used again, not given back: a
                       // tenth of the helper's time.
                       {"MALLOC_MMAP_THRESHOLD_", "1000000000"},
                       {"MALLOC_TRIM_THRESHOLD_", "1000000000"},
                       {"MALLOC_TOP_PAD_", "67108864"}};
  if (display.server) {
    child.environment.emplace_back("LIBGL_ALWAYS_SOFTWARE", "1");
    child.environment.emplace_back("XAUTHORITY", display.key.string());
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
  std::string warning;
  try {
    const std::string helper =
        require_helper(kHelper, kHelperVariable,
                       fmt::format("set {} to its path", kHelperVariable));
    const PrivateFolder folder;
    const Display display = open_display(folder, options.niceness);
    if (display.name.empty()) {
      return {fmt::format("no pictures: there is no display and {}",
                          display.problem)};
    }
    warning = render_with(helper, display, folder, jobs, options);
  } catch (const IoError& error) {
    warning = fmt::format("no pictures: {}", error.what());
  }
  return warning.empty() ? std::vector<std::string>{}
                         : std::vector<std::string>{warning};
}

struct PicturesBeside::StopMonitor : Monitor {
  explicit StopMonitor(Monitor* watched) : outer(watched) {}
  bool stop_requested() const override {
    return stop || (outer != nullptr && outer->stop_requested());
  }
  std::atomic<bool> stop = false;
  Monitor* outer;
};

PicturesBeside::PicturesBeside(std::vector<PictureJob> jobs,
                               const PictureOptions& options)
    : monitor_(std::make_unique<StopMonitor>(options.monitor)) {
  PictureOptions own = options;
  own.monitor = monitor_.get();
  own.niceness = kNiceness;
  own.time_limit = kTimeBeside;
  warnings_ = std::async(std::launch::async, [jobs = std::move(jobs), own] {
    return render_pictures(jobs, own);
  });
}

PicturesBeside::~PicturesBeside() {
  monitor_->stop = true;
  if (warnings_.valid()) {
    warnings_.wait();
  }
}

std::vector<std::string> PicturesBeside::wait() { return warnings_.get(); }

}  // namespace meniscus::picture
