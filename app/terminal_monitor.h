/// The monitor that people see: progress and messages on a terminal or in a
/// pipe, and a log for programs.
#pragma once

#include <cstdio>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "core/monitor.h"

namespace meniscus {

enum class MonitorStyle {
  Automatic,  // Terminal when the stream is one (and TERM is not "dumb")
  Terminal,   // one status line, redrawn in place, messages above it
  Lines,      // plain lines, at most one per second and stage
  Quiet       // errors only
};

struct TerminalMonitorOptions {
  MonitorStyle style = MonitorStyle::Automatic;
  std::FILE* stream = stderr;  // not owned
  /// JSON lines, appended: {"time", "severity", "message"} or {"time",
  /// "stage", "detail", "fraction"}; empty: none. Debug messages go here only.
  std::string log_file = {};
  /// The stage that runs others inside it: its last detail (evaluation, best
  /// so far) stays in the status line before theirs.
  std::string outer_stage = "match";
  std::function<bool()> stop = {};     // what stop_requested() answers
  std::function<double()> clock = {};  // [s]; empty: the steady clock
  int columns = 0;                     // of the terminal; 0: asked of it
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
  bool stop_requested() const override;

 private:
  void draw(const Progress& progress, double now);
  void erase_status();
  void show_status();
  void print_line(const std::string& line);
  void write_log(const std::string& line);
  double now() const;

  TerminalMonitorOptions options_;
  std::mutex mutex_;
  std::FILE* log_ = nullptr;
  std::string outer_;   // last detail of the outer stage
  std::string stage_;   // the one under way
  double began_ = 0.0;  // when it began [s]
  std::string status_;  // as drawn; empty: none on the screen
  double drawn_ = 0.0;  // when [s]
  std::map<std::string, double> printed_;  // last line per stage [s]
  std::map<std::string, double> logged_;   // likewise in the log
};

}  // namespace meniscus
