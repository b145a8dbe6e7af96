#include "app/terminal_monitor.h"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/ioctl.h>

#include "core/error.h"

namespace meniscus {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRedraw = 0.1;  // [s] between two drawings of the status line
constexpr double kLines = 1.0;   // [s] between two lines of one stage
constexpr int kColumns = 80;     // of a terminal that does not tell

bool is_terminal(std::FILE* stream) {
  const char* term = std::getenv("TERM");
  return isatty(fileno(stream)) != 0 &&
         (term == nullptr || std::string_view(term) != "dumb");
}

int columns_of(std::FILE* stream) {
  winsize size{};
  const bool told =
      ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return told ? size.ws_col : kColumns;
}

const char* prefix(Severity severity) {
  switch (severity) {
    case Severity::Warning:
      return "warning: ";
    case Severity::Error:
      return "error: ";
    default:
      return "";
  }
}

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::Debug:
      return "debug";
    case Severity::Info:
      return "info";
    case Severity::Warning:
      return "warning";
    case Severity::Error:
      return "error";
  }
  return "unknown";
}

std::string duration(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 100) {
    return fmt::format("{} s", whole);
  }
  return whole < 6000 ? fmt::format("{} min", (whole + 59) / 60)
                      : fmt::format("{} h", (whole + 3599) / 3600);
}

// "fea: iteration 12 (45 %, 7 s left)"; `elapsed` since the stage began [s].
std::string describe(const Progress& progress, double elapsed) {
  std::string text = progress.stage;
  if (!progress.detail.empty()) {
    text += ": " + progress.detail;
  }
  const double done = progress.fraction;
  if (done >= 0.0 && done <= 1.0) {
    text += fmt::format(" ({:.0f} %", 100.0 * done);
    if (done > 0.0 && done < 1.0 && elapsed > 0.0) {
      text += fmt::format(", {} left", duration(elapsed * (1.0 - done) / done));
    }
    text += ")";
  }
  return text;
}

// At most `columns` characters of UTF-8 text, on one line.
std::string fitted(const std::string& text, int columns) {
  std::string line;
  int used = 0;
  for (const char c : text) {
    const bool starts = (c & 0xc0) != 0x80;
    if (starts && ++used > columns) {
      break;
    }
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    line += control ? ' ' : c;
  }
  return line;
}

std::string timestamp() {
  const auto now = std::chrono::system_clock::now();
  const auto milliseconds =
      std::chrono::duration_cast<std::chrono::milliseconds>(
          now.time_since_epoch())
          .count();
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)),
                     milliseconds % 1000);
}

// True, and remembered, when the last time for `stage` is long enough ago.
bool due(std::map<std::string, double>& last, const std::string& stage,
         double now) {
  const auto [entry, is_new] = last.try_emplace(stage, now);
  if (!is_new && now - entry->second < kLines) {
    return false;
  }
  entry->second = now;
  return true;
}

}  // namespace

TerminalMonitor::TerminalMonitor(TerminalMonitorOptions options)
    : options_(std::move(options)) {
  if (options_.style == MonitorStyle::Automatic) {
    options_.style = is_terminal(options_.stream) ? MonitorStyle::Terminal
                                                  : MonitorStyle::Lines;
  }
  if (!options_.log_file.empty()) {
    log_ = std::fopen(options_.log_file.c_str(), "ae");
    if (log_ == nullptr) {
      throw IoError(fmt::format(
          "log file '{}' cannot be written: {}; choose another with --log",
          options_.log_file,
          std::error_code(errno, std::generic_category()).message()));
    }
  }
}

TerminalMonitor::~TerminalMonitor() {
  erase_status();
  if (log_ != nullptr) {
    std::fclose(log_);
  }
}

void TerminalMonitor::log(Severity severity, const std::string& message) {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (log_ != nullptr) {
    const Json line = {{"time", timestamp()},
                       {"severity", name_of(severity)},
                       {"message", message}};
    write_log(line.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
  const Severity least =
      options_.style == MonitorStyle::Quiet ? Severity::Error : Severity::Info;
  if (severity >= least) {
    print_line(prefix(severity) + message);
  }
}

void TerminalMonitor::progress(const Progress& progress) {
  const std::lock_guard<std::mutex> guard(mutex_);
  const double time = now();
  if (log_ != nullptr && due(logged_, progress.stage, time)) {
    const Json line = {{"time", timestamp()},
                       {"stage", progress.stage},
                       {"detail", progress.detail},
                       {"fraction", progress.fraction}};
    write_log(line.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
  if (progress.stage != stage_) {
    stage_ = progress.stage;
    began_ = time;
    drawn_ = -std::numeric_limits<double>::infinity();  // shows at once
  }
  if (progress.stage == options_.outer_stage) {
    outer_ = describe(progress, 0.0);
  }
  if (options_.style == MonitorStyle::Terminal) {
    draw(progress, time);
  } else if (options_.style == MonitorStyle::Lines &&
             due(printed_, progress.stage, time)) {
    print_line(describe(progress, time - began_));
  }
}

bool TerminalMonitor::stop_requested() const {
  return options_.stop && options_.stop();
}

void TerminalMonitor::draw(const Progress& progress, double now) {
  if (now - drawn_ < kRedraw) {
    return;
  }
  drawn_ = now;
  const bool inner = !outer_.empty() && progress.stage != options_.outer_stage;
  erase_status();
  status_ = (inner ? outer_ + " | " : "") + describe(progress, now - began_);
  show_status();
}

void TerminalMonitor::erase_status() {
  if (!status_.empty()) {
    std::fputs("\r\x1b[K", options_.stream);
    std::fflush(options_.stream);
    status_.clear();
  }
}

void TerminalMonitor::show_status() {
  // The last column stays free: some terminals wrap when it is written.
  const int columns =
      options_.columns > 0 ? options_.columns : columns_of(options_.stream);
  std::fputs(fitted(status_, columns - 1).c_str(), options_.stream);
  std::fflush(options_.stream);
}

void TerminalMonitor::print_line(const std::string& line) {
  const std::string status = status_;
  erase_status();
  std::fputs((line + '\n').c_str(), options_.stream);
  std::fflush(options_.stream);
  if (!status.empty()) {
    status_ = status;
    show_status();
  }
}

void TerminalMonitor::write_log(const std::string& line) {
  if (std::fputs((line + '\n').c_str(), log_) < 0 || std::fflush(log_) != 0) {
    const int code = errno;
    std::fclose(log_);
    log_ = nullptr;
    if (options_.style != MonitorStyle::Quiet) {
      print_line(fmt::format(
          "warning: log file '{}' ends here, it cannot be written: {}",
          options_.log_file,
          std::error_code(code, std::generic_category()).message()));
    }
  }
}

double TerminalMonitor::now() const {
  if (options_.clock) {
    return options_.clock();
  }
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace meniscus
