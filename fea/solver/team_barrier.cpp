#include "fea/solver/team_barrier.h"

#include <algorithm>
#include <chrono>
#include <climits>
#include <unistd.h>

#include <linux/futex.h>
#include <sys/syscall.h>

namespace meniscus::solver {

namespace {

using Clock = std::chrono::steady_clock;
using Nanoseconds = std::int64_t;

constexpr Nanoseconds kMost = 100'000;
constexpr Nanoseconds kLeast = 2'000;  // about what falling asleep costs

/// How long it pays to spin: shared by all barriers, a hint without order.
std::atomic<Nanoseconds> patience = kMost;

Nanoseconds since(Clock::time_point start) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() -
                                                              start)
      .count();
}

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

// std::atomic's wait() yields first, which on a busy machine costs a whole time
// slice.
void sleep_while(std::atomic<std::uint32_t>& word, std::uint32_t value) {
  syscall(SYS_futex, &word, FUTEX_WAIT_PRIVATE, value, nullptr, nullptr, 0);
}
void wake_all(std::atomic<std::uint32_t>& word) {
  syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, INT_MAX, nullptr, nullptr, 0);
}

/// A short wait makes the next ones more patient, a long one less.
void learn(Nanoseconds waited) {
  const Nanoseconds now = patience.load(std::memory_order_relaxed);
  const Nanoseconds next =
      waited <= kMost ? std::max(now - now / 8, 2 * waited) : now / 2;
  patience.store(std::clamp(next, kLeast, kMost), std::memory_order_relaxed);
}

}  // namespace

void TeamBarrier::wait(int threads) {
  if (threads == 1) {
    return;
  }
  const std::uint32_t phase = phase_.load(std::memory_order_acquire);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) == threads - 1) {
    arrived_.store(0, std::memory_order_relaxed);
    phase_.store(phase + 1, std::memory_order_seq_cst);
    if (sleepers_.load(std::memory_order_seq_cst) > 0) {
      wake_all(phase_);
    }
    return;
  }
  const Clock::time_point start = Clock::now();
  const Nanoseconds limit = patience.load(std::memory_order_relaxed);
  while (phase_.load(std::memory_order_acquire) == phase) {
    if (since(start) > limit) {
      sleepers_.fetch_add(1, std::memory_order_seq_cst);
      while (phase_.load(std::memory_order_seq_cst) == phase) {
        sleep_while(phase_, phase);
      }
      sleepers_.fetch_sub(1, std::memory_order_relaxed);
      break;
    }
    pause();
  }
  learn(since(start));
}

}  // namespace meniscus::solver
