#include "app/terminal_monitor.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/terminal.h"

namespace meniscus::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRedraw = 0.1;  // [s] between two drawings of the status line
constexpr double kLogged = 1.0;  // [s] between two of one stage in the log
constexpr double kSilence = 10.0;  // [s] after which a pipe gets a sign of life

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

// True, and remembered, when the last time for `stage` is long enough ago.
bool due(std::map<std::string, double>& last, const std::string& stage,
         double now) {
  const auto [entry, is_new] = last.try_emplace(stage, now);
  if (!is_new && now - entry->second < kLogged) {
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
    log_ = std::make_unique<JsonLog>(options_.log_file);
  }
  start_ = now();
  line_ = start_;
}

TerminalMonitor::~TerminalMonitor() { erase_status(); }

void TerminalMonitor::log(Severity severity, const std::string& message) {
  const std::lock_guard<std::mutex> guard(mutex_);
  write_log(name_of(severity), now(),
            {{"event", "message"}, {"stage", stage_}, {"message", message}});
  const Severity least =
      options_.style == MonitorStyle::Quiet ? Severity::Error : Severity::Info;
  if (severity >= least) {
    print_line(prefix(severity) + message);
  }
}

void TerminalMonitor::write(const MonitorEvent& event) {
  const std::lock_guard<std::mutex> guard(mutex_);
  write_log("info", now(), event.fields);
  if (!event.status.empty()) {
    outer_ = event.status;
    events_ = true;
  }
  if (!event.line.empty() && options_.style != MonitorStyle::Quiet) {
    print_line(event.line);
  }
}

void TerminalMonitor::progress(const Progress& progress) {
  const std::lock_guard<std::mutex> guard(mutex_);
  const double time = now();
  if (log_ != nullptr && due(logged_, progress.stage, time)) {
    const bool known = progress.fraction >= 0.0 && progress.fraction <= 1.0;
    write_log("info", time,
              {{"event", "progress"},
               {"stage", progress.stage},
               {"detail", progress.detail},
               {"fraction", known ? Json(progress.fraction) : Json()}});
  }
  if (progress.stage == options_.outer_stage) {
    if (events_) {
      return;  // an event told it, in more words
    }
    outer_ = describe(progress, 0.0);
  }
  if (progress.stage != stage_) {
    stage_ = progress.stage;
    began_ = time;
    drawn_ = -std::numeric_limits<double>::infinity();  // shows at once
  }
  if (options_.style == MonitorStyle::Terminal) {
    draw(progress, time);
  } else if (options_.style == MonitorStyle::Lines &&
             (stages_.insert(progress.stage).second ||
              time - line_ >= kSilence)) {
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
  std::fputs(truncate_to(status_, columns - 1).c_str(), options_.stream);
  std::fflush(options_.stream);
}

void TerminalMonitor::print_line(const std::string& line) {
  line_ = now();
  const std::string status = status_;
  erase_status();
  std::fputs((line + '\n').c_str(), options_.stream);
  std::fflush(options_.stream);
  if (!status.empty()) {
    status_ = status;
    show_status();
  }
}

void TerminalMonitor::write_log(const char* level, double now,
                                const Json& fields) {
  if (log_ == nullptr) {
    return;
  }
  Json line = {{"level", level}, {"seconds", now - start_}};
  line.update(fields);
  if (!log_->write(line)) {
    const std::string problem = log_->problem();
    log_.reset();
    if (options_.style != MonitorStyle::Quiet) {
      print_line(
          fmt::format("warning: log file '{}' ends here, it cannot be written: "
                      "{}",
                      options_.log_file, problem));
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

}  // namespace meniscus::app
