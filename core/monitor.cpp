#include "core/monitor.h"

#include "core/error.h"

namespace meniscus {

Monitor& silent_monitor() {
  static Monitor monitor;
  return monitor;
}

void throw_if_stopped(const Monitor& monitor, const char* stage) {
  if (monitor.stop_requested()) {
    throw Interrupted(std::string("stopped on request during ") + stage);
  }
}

}  // namespace meniscus
