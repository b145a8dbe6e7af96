/// What a stage takes: seconds and counted operations.
#pragma once

#include "core/operation_count.h"
#include "core/timer.h"

namespace meniscus {

/// Runs from its construction, on the constructing thread.
class StageMeter {
 public:
  /// Adds to both what was taken since the construction.
  void add_to(double& seconds, double& operations) const {
    seconds += timer_.seconds();
    operations += operations_done() - before_;
  }

 private:
  Timer timer_;
  double before_ = operations_done();
};

}  // namespace meniscus
