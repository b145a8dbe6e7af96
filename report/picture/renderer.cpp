#include "report/picture/renderer.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>

#include <fmt/format.h>

#include "core/child_process.h"
#include "core/error.h"
#include "core/find_program.h"
#include "report/picture/private_display.h"

namespace meniscus::picture {

namespace {

constexpr const char* kHelper = "meniscus-render";
constexpr const char* kHelperVariable = "MENISCUS_RENDER";
constexpr std::string_view kNone = "no pictures: ";
constexpr std::string_view kIncomplete = "pictures are missing or incomplete: ";
// Beside the caller's work: a third of its share of a processor that both
// want, and time enough for that.
constexpr int kNiceness = 5;
constexpr double kTimeBeside = 600.0;  // [s]

std::string in_one_line(std::string text) {
  while (!text.empty() &&
         std::isspace(static_cast<unsigned char>(text.back())) != 0) {
    text.pop_back();
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string incomplete(const std::string& reason) {
  return std::string(kIncomplete) + reason;
}

/// The helper on its display, for one thread.
class Helper {
 public:
  /// Throws IoError where it cannot be started.
  Helper() : display_(kNiceness) {
    const std::string program =
        require_helper(kHelper, kHelperVariable,
                       fmt::format("set {} to its path", kHelperVariable));
    if (display_.name().empty()) {
      throw IoError(
          fmt::format("there is no display and {}", display_.problem()));
    }
    ChildOptions options;
    options.argv = {program};
    options.error_tail = 1000;
    options.niceness = kNiceness;
    options.environment = display_.environment();
    // Pictures' memory is used again, not given back: a tenth of the time.
    options.environment.emplace_back("MALLOC_MMAP_THRESHOLD_", "1000000000");
    options.environment.emplace_back("MALLOC_TRIM_THRESHOLD_", "1000000000");
    options.environment.emplace_back("MALLOC_TOP_PAD_", "67108864");
    child_ = std::make_unique<AskedChild>(options);
  }

  /// What failed, in words, or nothing. Throws Interrupted.
  std::string draw(const std::vector<PictureJob>& jobs,
                   const PictureOptions& options) {
    child_->set_limits(options.time_limit, options.monitor);
    if (const auto failed = child_->ask(to_bytes(jobs))) {
      return in_one_line(*failed);
    }
    is_alive_ = false;
    const ChildResult& end = child_->end();
    if (end.stopped) {
      throw Interrupted("stopped on request during pictures");
    }
    const std::string said = in_one_line(end.error_tail);
    return fmt::format("{} {}{}{}", kHelper, describe_end(end),
                       said.empty() ? "" : ": ", said);
  }

  bool is_alive() const { return is_alive_; }
  /// Of one that is not: nobody ended it for its time.
  bool ended_by_itself() const { return !child_->end().timed_out; }

 private:
  PrivateDisplay display_;
  std::unique_ptr<AskedChild> child_;
  bool is_alive_ = true;
};

}  // namespace

struct Renderer::Impl {
  struct Task {
    std::vector<PictureJob> jobs;
    PictureOptions options;
    std::promise<std::vector<std::string>> warnings;
  };

  void work() {
    std::optional<Helper> helper;  // ends with the thread that started it
    while (true) {
      Task task;
      {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return is_over || !tasks.empty(); });
        if (is_over) {
          break;
        }
        task = std::move(tasks.front());
        tasks.pop_front();
      }
      try {
        task.warnings.set_value(draw(task, helper));
      } catch (...) {
        task.warnings.set_exception(std::current_exception());
      }
      if (helper && !helper->is_alive()) {
        helper.reset();
      }
    }
    for (Task& task : tasks) {
      task.warnings.set_exception(std::make_exception_ptr(
          Interrupted("pictures were given up with the run")));
    }
  }

  static std::vector<std::string> draw(const Task& task,
                                       std::optional<Helper>& helper) {
    if (task.options.monitor != nullptr) {
      throw_if_stopped(*task.options.monitor, "pictures");
    }
    std::string failed;
    // One that was ended since its last pictures, or its display, is no reason
    // to go without them.
    for (bool is_new = false; !is_new;) {
      is_new = !helper;
      try {
        if (is_new) {
          helper.emplace();
        }
      } catch (const IoError& error) {
        return {std::string(kNone) + error.what()};
      }
      failed = helper->draw(task.jobs, task.options);
      if (helper->is_alive() || !helper->ended_by_itself()) {
        break;
      }
      if (!is_new) {
        helper.reset();
      }
    }
    return failed.empty() ? std::vector<std::string>{}
                          : std::vector<std::string>{incomplete(failed)};
  }

  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Task> tasks;
  bool is_over = false;
  std::thread worker;
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}

Renderer::~Renderer() {
  {
    const std::scoped_lock lock(impl_->mutex);
    impl_->is_over = true;
  }
  impl_->changed.notify_all();
  if (impl_->worker.joinable()) {
    impl_->worker.join();
  }
}

std::future<std::vector<std::string>> Renderer::begin(
    std::vector<PictureJob> jobs, const PictureOptions& options) {
  Impl::Task task{std::move(jobs), options, {}};
  std::future<std::vector<std::string>> warnings = task.warnings.get_future();
  if (task.jobs.empty()) {
    task.warnings.set_value({});
    return warnings;
  }
  {
    const std::scoped_lock lock(impl_->mutex);
    impl_->tasks.push_back(std::move(task));
    if (!impl_->worker.joinable()) {
      impl_->worker = std::thread([impl = impl_.get()] { impl->work(); });
    }
  }
  impl_->changed.notify_all();
  return warnings;
}

std::vector<std::string> Renderer::render(std::vector<PictureJob> jobs,
                                          const PictureOptions& options) {
  return begin(std::move(jobs), options).get();
}

bool is_about_pictures(const std::string& warning) {
  return warning.starts_with(kNone) || warning.starts_with(kIncomplete);
}

std::vector<std::string> render_pictures(std::vector<PictureJob> jobs,
                                         const PictureOptions& options) {
  return Renderer().render(std::move(jobs), options);
}

struct PicturesBeside::StopMonitor : Monitor {
  explicit StopMonitor(Monitor* watched) : outer(watched) {}
  bool stop_requested() const override {
    return stop || (outer != nullptr && outer->stop_requested());
  }
  std::atomic<bool> stop = false;
  Monitor* outer;
};

PicturesBeside::PicturesBeside(Renderer& renderer, std::vector<PictureJob> jobs,
                               Monitor* monitor)
    : monitor_(std::make_unique<StopMonitor>(monitor)),
      warnings_(renderer.begin(std::move(jobs), {.time_limit = kTimeBeside,
                                                 .monitor = monitor_.get()})) {}

PicturesBeside::~PicturesBeside() {
  monitor_->stop = true;
  if (warnings_.valid()) {
    warnings_.wait();
  }
}

std::vector<std::string> PicturesBeside::wait() { return warnings_.get(); }

}  // namespace meniscus::picture
