/// Helper programs run as child processes, so that a library that ends its
/// process (TetGen, VTK without a display) cannot end ours.
///
/// A child gets its own process group (Ctrl-C in the terminal does not reach
/// it), no core dump and no open file but its three streams. It is ended when
/// the thread that started it ends.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "core/monitor.h"

namespace meniscus {

struct ChildOptions {
  /// Program (a path, or a name looked up in PATH) and its arguments.
  std::vector<std::string> argv;
  /// Variables set (or, without a value, removed) on top of the caller's own.
  std::vector<std::pair<std::string, std::optional<std::string>>> environment;
  std::filesystem::path folder;        // working folder; empty: the caller's
  std::string_view input;              // written to stdin, binary; not owned
  std::optional<double> time_limit;    // wall clock [s]; then it is killed
  std::optional<double> memory_limit;  // address space [byte]
  std::size_t error_tail = 4000;       // bytes kept of the end of stderr
  int niceness = 0;  // 0..19, how far it stands back behind the caller's work
  Monitor* monitor = nullptr;  // polled for a stop every 50 ms
};

struct ChildResult {
  int exit_code = -1;      // -1: it did not exit by itself
  int signal = 0;          // that ended it; 0: it exited by itself
  bool timed_out = false;  // killed at the time limit
  bool stopped = false;    // killed because the monitor asked to stop
  std::string output;      // stdout, binary
  std::string error_tail;  // end of stderr
  double seconds = 0.0;    // wall clock

  bool succeeded() const { return exit_code == 0 && !timed_out && !stopped; }
};

/// Runs a program to its end. Throws IoError when it cannot be started (not
/// found, no permission); whatever happens later is in the result.
ChildResult run_child(const ChildOptions& options);

/// How a child ended, in words: "ended with exit code 3", "killed by signal
/// 11 (Segmentation fault)", "stopped after the time limit of 60 s".
std::string describe_end(const ChildResult& result);

/// A child that answers questions one after another (core/frame.h); its
/// destructor ends it.
class AskedChild {
 public:
  /// `input` is not used; the time limit is that of each question. Throws
  /// IoError when it cannot be started.
  explicit AskedChild(const ChildOptions& options);
  ~AskedChild();
  AskedChild(const AskedChild&) = delete;
  AskedChild& operator=(const AskedChild&) = delete;

  /// Of the questions from now on, in place of those of the options.
  void set_limits(std::optional<double> time_limit, Monitor* monitor);

  /// Its answer. Nothing where it ended, was stopped or ran into its time
  /// limit: end() says how, and it answers no more.
  std::optional<std::string> ask(std::string_view question);
  const ChildResult& end() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A child that runs beside its caller (a virtual display); its destructor
/// ends it: SIGTERM, after `grace` seconds SIGKILL. No input, no limits; its
/// stderr is discarded.
class BackgroundChild {
 public:
  /// Throws IoError when the program cannot be started.
  explicit BackgroundChild(const ChildOptions& options, double grace = 2.0);
  ~BackgroundChild();
  BackgroundChild(const BackgroundChild&) = delete;
  BackgroundChild& operator=(const BackgroundChild&) = delete;

  /// The next line of its stdout, without line end; nothing when it ended or
  /// wrote none within `seconds`.
  std::optional<std::string> read_line(double seconds);

 private:
  pid_t process_ = -1;
  int output_ = -1;
  double grace_;
  std::string pending_;
};

}  // namespace meniscus
