#include "python/call.h"

#include <chrono>
#include <exception>
#include <omp.h>
#include <thread>

#include "core/error.h"

namespace meniscus::python {

namespace {

// Python's signal handlers run when it is asked; a person waits no longer.
constexpr std::chrono::milliseconds kListen{50};

std::atomic<int> wanted_threads = 0;
thread_local Monitor* this_call = nullptr;

class ThreadMonitor final : public Monitor {
 public:
  void progress(const Progress& progress) override {
    if (this_call != nullptr) {
      this_call->progress(progress);
    }
  }
  bool stop_requested() const override {
    return this_call != nullptr && this_call->stop_requested();
  }
};

}  // namespace

Call::Call(py::object progress) : heard_by_(std::move(progress)) {
  if (!heard_by_.is_none() && PyCallable_Check(heard_by_.ptr()) == 0) {
    throw InvalidInput(
        "progress: expected a function of (stage, detail, fraction)");
  }
}

Monitor& Call::of_this_thread() {
  static ThreadMonitor monitor;
  return monitor;
}

void Call::progress(const Progress& progress) {
  const std::lock_guard lock(mutex_);
  news_.push_back(progress);
  changed_.notify_one();
}

void Call::keep_error() {
  if (error_ == nullptr) {
    error_ = std::make_unique<py::error_already_set>();
  } else {
    PyErr_Clear();
  }
  stop_ = true;
}

/// Needs the interpreter's lock.
void Call::attend() {
  std::vector<Progress> news;
  {
    const std::lock_guard lock(mutex_);
    news.swap(news_);
  }
  if (PyErr_CheckSignals() != 0) {
    keep_error();
  }
  if (heard_by_.is_none()) {
    return;
  }
  for (const Progress& item : news) {
    if (stop_) {
      return;
    }
    try {
      heard_by_(item.stage, item.detail,
                item.fraction < 0.0 ? py::object(py::none())
                                    : py::object(py::float_(item.fraction)));
    } catch (py::error_already_set& error) {
      error.restore();
      keep_error();
    }
  }
}

void Call::run(const std::function<void()>& work) {
  std::exception_ptr thrown;
  {
    const py::gil_scoped_release release;
    std::thread worker([&] {
      this_call = this;
      if (wanted_threads > 0) {
        omp_set_num_threads(wanted_threads);
      }
      try {
        work();
      } catch (...) {
        thrown = std::current_exception();
      }
      const std::lock_guard lock(mutex_);
      done_ = true;
      changed_.notify_one();
    });
    std::unique_lock lock(mutex_);
    while (!done_) {
      changed_.wait_for(lock, kListen, [&] { return done_ || !news_.empty(); });
      lock.unlock();
      {
        const py::gil_scoped_acquire acquire;
        attend();
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  attend();
  if (error_ != nullptr) {
    error_->restore();
    throw py::error_already_set();
  }
  if (thrown != nullptr) {
    std::rethrow_exception(thrown);
  }
}

void set_thread_count(int threads) {
  if (threads < 0) {
    throw InvalidInput("set_threads: found " + std::to_string(threads) +
                       ", expected 1 or more, or 0 for all");
  }
  wanted_threads = threads;
}

int thread_count() {
  return wanted_threads > 0 ? wanted_threads.load() : omp_get_max_threads();
}

}  // namespace meniscus::python
