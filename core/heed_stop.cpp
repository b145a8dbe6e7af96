#include "core/heed_stop.h"

#include <chrono>

namespace meniscus {

namespace {

using HeedClock = std::chrono::steady_clock;

thread_local const Monitor* heeded = nullptr;
thread_local HeedClock::time_point last_asked;

}  // namespace

Heeding::Heeding(const Monitor* monitor) : before_(heeded) {
  if (monitor != nullptr) {
    heeded = monitor;
  }
}

Heeding::~Heeding() { heeded = before_; }

void heed_stop(const char* stage) {
  if (heeded == nullptr) {
    return;
  }
  constexpr std::chrono::milliseconds kBetween(20);
  const auto now = HeedClock::now();
  if (now - last_asked >= kBetween) {
    last_asked = now;
    throw_if_stopped(*heeded, stage);
  }
}

}  // namespace meniscus
