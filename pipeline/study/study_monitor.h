/// The monitor between a study's evaluations and its user.
#pragma once

#include <atomic>
#include <chrono>

#include "core/monitor.h"
#include "core/timer.h"

namespace meniscus::study {

/// Hands on what it hears. While muted the stages' own progress is not told:
/// side by side they would talk all at once. May be called from several
/// threads if `user` may.
class StudyMonitor : public Monitor {
 public:
  using Clock = std::chrono::steady_clock;

  /// `user` must outlive this; null: nobody.
  explicit StudyMonitor(Monitor* user)
      : user_(user != nullptr ? *user : silent_monitor()) {}

  void log(Severity severity, const std::string& message) override {
    user_.log(severity, message);
  }
  void progress(const Progress& progress) override {
    if (!muted_) {
      user_.progress(progress);
    }
  }
  bool stop_requested() const override {
    return cancelled_ || user_.stop_requested() ||
           (hurried_ && Clock::now() >= deadline_);
  }

  Monitor& user() { return user_; }
  bool user_stops() const { return user_.stop_requested(); }

  /// For as long as it lives: muted, and stopped at the deadline if there is
  /// one. Not for several threads.
  class Group {
   public:
    Group(StudyMonitor& monitor, const Clock::time_point* deadline)
        : monitor_(monitor) {
      monitor_.muted_ = true;
      monitor_.cancelled_ = false;
      monitor_.hurried_ = deadline != nullptr;
      if (deadline != nullptr) {
        monitor_.deadline_ = *deadline;
      }
    }
    ~Group() {
      monitor_.muted_ = false;
      monitor_.cancelled_ = false;
      monitor_.hurried_ = false;
    }
    Group(const Group&) = delete;
    Group& operator=(const Group&) = delete;

    void cancel() { monitor_.cancelled_ = true; }

   private:
    StudyMonitor& monitor_;
  };

 private:
  Monitor& user_;
  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> muted_ = false;
  std::atomic<bool> hurried_ = false;
  Clock::time_point deadline_;
};

/// Asks to stop when the time is up too. May be called from several threads if
/// `user` may.
class DeadlineMonitor : public Monitor {
 public:
  /// `user` must outlive this; `limit` counts from now [s], 0: none.
  DeadlineMonitor(Monitor& user, double limit) : user_(user), limit_(limit) {}

  void log(Severity severity, const std::string& message) override {
    user_.log(severity, message);
  }
  void progress(const Progress& progress) override { user_.progress(progress); }
  bool stop_requested() const override {
    return user_.stop_requested() || expired();
  }

  bool expired() const {
    return limit_ > 0.0 && !lifted_ && timer_.seconds() >= limit_;
  }
  double limit() const { return limit_; }
  /// From now on there is no limit.
  void lift() { lifted_ = true; }

 private:
  Monitor& user_;
  double limit_;
  std::atomic<bool> lifted_ = false;
  Timer timer_;
};

}  // namespace meniscus::study
