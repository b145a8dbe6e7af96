/// Where the threads of one parallel region wait for each other.
#pragma once

#include <atomic>
#include <cstdint>

namespace meniscus::solver {

/// A barrier for loops of some ten microseconds. A thread that slept wakes late
/// (20 us and more in a virtual machine), one that spins is in the way when
/// another program wants its core. So it spins for about twice as long as
/// waits lately took, at most 100 us, and then sleeps: on an idle machine it
/// never sleeps, on a busy one it hardly spins (docs/performance.md).
class TeamBarrier {
 public:
  /// Returns when `threads` threads have called it. May be used again at once.
  void wait(int threads);

 private:
  std::atomic<int> arrived_{0};
  std::atomic<std::uint32_t> phase_{0};
  std::atomic<int> sleepers_{0};
};

}  // namespace meniscus::solver
