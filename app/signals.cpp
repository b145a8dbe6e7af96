#include "app/signals.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <initializer_list>
#include <string_view>
#include <thread>
#include <unistd.h>

namespace meniscus::app {
namespace {

constexpr int kInterrupted = 130;

// After a signal that no loop asks for, and after one that is heard.
constexpr std::chrono::seconds kDeaf(5);
constexpr std::chrono::seconds kSlow(60);

std::atomic<int> received{0};
std::atomic<bool> heard{false};
static_assert(std::atomic<int>::is_always_lock_free,
              "a signal handler must not lock");
std::array<int, 2> wake = {-1, -1};  // the handler writes, the watch reads

extern "C" void on_stop_signal(int signal) {
  int none = 0;
  if (!received.compare_exchange_strong(none, signal)) {
    _exit(kInterrupted);
  }
  const int before = errno;
  [[maybe_unused]] const auto sent = ::write(wake[1], "", 1);
  errno = before;
}

/// Ends the process where the computation does not end by itself: it may stand
/// in a library that nobody can ask to stop. Finished evaluations are in the
/// study's database.
void watch_stop() {
  using Clock = std::chrono::steady_clock;
  char byte = 0;
  while (::read(wake[0], &byte, 1) < 0 && errno == EINTR) {
  }
  const auto begin = Clock::now();
  while (Clock::now() - begin < (heard ? kSlow : kDeaf)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  const std::string_view text =
      "ended in the middle of a step that does not stop; finished evaluations "
      "are kept, --resume goes on with them\n";
  [[maybe_unused]] const auto said =
      ::write(STDERR_FILENO, text.data(), text.size());
  _exit(kInterrupted);
}

}  // namespace

void catch_stop_signals() {
  if (wake[0] < 0 && ::pipe2(wake.data(), O_CLOEXEC) == 0) {
    std::thread(watch_stop).detach();
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) {
      continue;
    }
    action = {};
    action.sa_handler = on_stop_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

int stop_signal() noexcept {
  const int signal = received.load();
  if (signal != 0) {
    heard = true;
  }
  return signal;
}

const char* name_of_signal(int signal) noexcept {
  switch (signal) {
    case SIGINT:
      return "Ctrl-C";
    case SIGTERM:
      return "SIGTERM";
    case SIGHUP:
      return "SIGHUP";
    default:
      return "a signal";
  }
}

}  // namespace meniscus::app
