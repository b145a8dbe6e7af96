/// One call from Python into the engine: on a thread of its own, without the
/// interpreter's lock. The calling thread waits, hands progress to the caller's
/// function and listens for Ctrl-C; so all that is Python happens on it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include <pybind11/pybind11.h>

#include "core/monitor.h"

namespace meniscus::python {

namespace py = pybind11;

class Call final : public Monitor {
 public:
  /// `progress`: None, or called with (stage, detail, fraction or None).
  explicit Call(py::object progress = py::none());

  /// Returns what `work` came to. What it throws passes; an exception of
  /// Python's (Ctrl-C, of `progress`) stops the work and passes instead.
  void run(const std::function<void()>& work);

  void progress(const Progress& progress) override;
  bool stop_requested() const override { return stop_; }

  /// A monitor that forwards to the call that the asking thread works for;
  /// for models, which outlive calls.
  static Monitor& of_this_thread();

 private:
  void attend();
  void keep_error();

  py::object heard_by_;
  std::atomic<bool> stop_ = false;
  std::unique_ptr<py::error_already_set> error_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Progress> news_;
  bool done_ = false;
};

/// OpenMP's threads of each call; 0: as many as OpenMP would take.
void set_thread_count(int threads);
int thread_count();

}  // namespace meniscus::python
