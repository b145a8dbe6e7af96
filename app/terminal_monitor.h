/// The monitor that people see: progress and messages on a terminal or in a
/// pipe, and a log for programs.
#pragma once

#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "app/json_log.h"
#include "core/monitor.h"

namespace meniscus::app {

enum class MonitorStyle {
  Automatic,  // Terminal when the stream is one (and TERM is not "dumb")
  Terminal,   // one status line, redrawn in place, messages above it
  Lines,      // plain lines: events, messages, the first of each stage, and
              // a sign of life where nothing else is told for ten seconds
  Quiet       // errors only
};

struct TerminalMonitorOptions {
  MonitorStyle style = MonitorStyle::Automatic;
  std::FILE* stream = stderr;  // not owned
  /// JSON lines, appended (docs/results.md); empty: none. Debug messages go
  /// here only.
  std::string log_file = {};
  /// The stage that runs others inside it: its last detail (evaluation, best
  /// so far) stays in the status line before theirs.
  std::string outer_stage = "match";
  std::function<bool()> stop = {};     // what stop_requested() answers
  std::function<double()> clock = {};  // [s]; empty: the steady clock
  int columns = 0;                     // of the terminal; 0: asked of it
};

/// Something worth a line of its own: an evaluation, an end.
struct MonitorEvent {
  std::string line;    // for people; empty: for the log only
  std::string status;  // stays in the status line before the stages' own;
                       // the outer stage's progress is then not shown
  nlohmann::ordered_json fields;  // for the log: "event", "stage", ...
};

/// May be called from several threads at once.
class TerminalMonitor : public Monitor {
 public:
  /// Throws IoError when the log file cannot be opened. A log that cannot be
  /// written later (full disk) ends with one warning, not the run.
  explicit TerminalMonitor(TerminalMonitorOptions options = {});
  ~TerminalMonitor() override;
  TerminalMonitor(const TerminalMonitor&) = delete;
  TerminalMonitor& operator=(const TerminalMonitor&) = delete;

  void log(Severity severity, const std::string& message) override;
  void progress(const Progress& progress) override;
  void write(const MonitorEvent& event);
  bool stop_requested() const override;

 private:
  void draw(const Progress& progress, double now);
  void erase_status();
  void show_status();
  void print_line(const std::string& line);
  void write_log(const char* level, double now,
                 const nlohmann::ordered_json& fields);
  double now() const;

  TerminalMonitorOptions options_;
  std::mutex mutex_;
  std::unique_ptr<JsonLog> log_;
  double start_ = 0.0;            // of the monitor [s]
  std::string outer_;             // status of the last event or the outer stage
  bool events_ = false;           // have set it
  std::string stage_;             // the one under way
  double began_ = 0.0;            // when it began [s]
  std::string status_;            // as drawn; empty: none on the screen
  double drawn_ = 0.0;            // when [s]
  std::set<std::string> stages_;  // that have had a line
  double line_ = 0.0;             // the last line of any kind [s]
  std::map<std::string, double> logged_;  // last line per stage in the log [s]
};

}  // namespace meniscus::app
