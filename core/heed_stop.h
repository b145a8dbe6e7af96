/// A stop that is heard in loops far below whoever was given a monitor.
#pragma once

#include "core/monitor.h"

namespace meniscus {

/// While it lives, heed_stop() of its thread asks this monitor; null: that of
/// the Heeding around it.
class Heeding {
 public:
  explicit Heeding(const Monitor* monitor);
  ~Heeding();
  Heeding(const Heeding&) = delete;
  Heeding& operator=(const Heeding&) = delete;

 private:
  const Monitor* before_;
};

/// For the rounds of loops that may be long: throw_if_stopped() of the thread's
/// innermost Heeding, once in 20 ms; a call costs what a look at the clock
/// does. Not from within an OpenMP region, which no exception may leave.
void heed_stop(const char* stage);

}  // namespace meniscus
