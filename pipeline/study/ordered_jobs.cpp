#include "pipeline/study/ordered_jobs.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <omp.h>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::study {

namespace {

class Crew {
 public:
  Crew(const OrderedJobs& jobs, int threads);
  ~Crew() { end(); }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Waits for the piece; throws what its work threw.
  void await(int piece);
  /// No more pieces, those under way are asked to end; waits for the threads.
  void end();

 private:
  void serve(int omp_threads);
  int next();

  const OrderedJobs& jobs_;
  std::mutex mutex_;
  std::condition_variable finished_;
  int next_ = 0;
  bool closed_ = false;  // a piece has thrown, or the caller has
  std::vector<char> done_;
  std::vector<std::exception_ptr> thrown_;
  std::vector<std::thread> threads_;
};

Crew::Crew(const OrderedJobs& jobs, int threads)
    : jobs_(jobs), done_(jobs.count, 0), thrown_(jobs.count) {
  const int share = std::max(1, omp_get_max_threads() / threads);
  threads_.reserve(threads);
  try {
    for (int t = 0; t < threads; ++t) {
      threads_.emplace_back([this, share] { serve(share); });
    }
  } catch (...) {  // the system refuses another thread
    end();
    throw;
  }
}

int Crew::next() {
  const std::lock_guard lock(mutex_);
  return closed_ || next_ == jobs_.count ? jobs_.count : next_++;
}

void Crew::serve(int omp_threads) {
  omp_set_num_threads(omp_threads);
  for (int piece = next(); piece < jobs_.count; piece = next()) {
    std::exception_ptr thrown;
    try {
      jobs_.work(piece);
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    closed_ = closed_ || thrown != nullptr;
    thrown_[piece] = std::move(thrown);
    done_[piece] = 1;
    finished_.notify_one();
  }
}

void Crew::await(int piece) {
  std::unique_lock lock(mutex_);
  // Pieces are begun in order: one before a piece that threw was begun too.
  finished_.wait(lock, [&] { return done_[piece] != 0; });
  if (thrown_[piece] != nullptr) {
    std::rethrow_exception(thrown_[piece]);
  }
}

void Crew::end() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = closed_ || next_ < jobs_.count ||
              !std::all_of(done_.begin(), done_.end(),
                           [](char done) { return done != 0; });
  }
  if (closed_ && jobs_.cancel) {
    jobs_.cancel();
  }
  for (std::thread& thread : threads_) {
    thread.join();
  }
  threads_.clear();
}

}  // namespace

void run_in_order(const OrderedJobs& jobs) {
  if (jobs.jobs < 1 || jobs.jobs > kMostJobs) {
    throw InvalidInput(
        fmt::format("jobs: found {}, expected 1 to {}", jobs.jobs, kMostJobs));
  }
  const int threads = std::min(jobs.jobs, jobs.count);
  if (threads <= 1) {
    for (int piece = 0; piece < jobs.count; ++piece) {
      jobs.work(piece);
      jobs.take(piece);
    }
    return;
  }
  Crew crew(jobs, threads);
  for (int piece = 0; piece < jobs.count; ++piece) {
    crew.await(piece);
    jobs.take(piece);
  }
}

}  // namespace meniscus::study
