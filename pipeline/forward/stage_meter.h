/// What stages take: seconds and counted operations.
#pragma once

#include "core/operation_count.h"
#include "core/timer.h"

namespace meniscus::forward {

struct StageSeconds {
  double film = 0.0;
  double mesh = 0.0;
  double fea = 0.0;
  double gradient = 0.0;

  StageSeconds& operator+=(const StageSeconds& other) {
    film += other.film;
    mesh += other.mesh;
    fea += other.fea;
    gradient += other.gradient;
    return *this;
  }
};

/// Floating-point operations (core/operation_count.h); 0 where they are not
/// counted: in other processes.
struct StageOperations {
  double film = 0.0;
  double mesh = 0.0;
  double fea = 0.0;
};

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

}  // namespace meniscus::forward
