/// Independent pieces of work on several threads, what they found taken in the
/// order of the pieces: the same for any number of threads.
#pragma once

#include <functional>

namespace meniscus::study {

/// Threads that a study may be given.
inline constexpr int kMostJobs = 64;

struct OrderedJobs {
  int count = 0;  // pieces, numbered from 0
  int jobs = 1;   // threads, 1 to kMostJobs; each gets its share of OpenMP's,
                  // at least one. 1: all is done on the calling thread
  /// Called once per piece, side by side. Must not touch what `take` does.
  std::function<void(int piece)> work;
  /// Called on the calling thread, pieces ascending, each as soon as all
  /// before it are done.
  std::function<void(int piece)> take;
  /// Asks the work under way to end soon by throwing; called when another
  /// piece, or `take`, has thrown. Optional.
  std::function<void()> cancel = {};
};

/// Returns when all pieces are taken. What work(k) or take(k) throws reaches
/// the caller once pieces 0 to k - 1 are taken and all threads have ended; what
/// was found beyond k is dropped.
void run_in_order(const OrderedJobs& jobs);

}  // namespace meniscus::study
