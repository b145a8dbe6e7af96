#include "app/signals.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <initializer_list>
#include <string_view>
#include <thread>
#include <unistd.h>
#include <utility>

namespace meniscus::app {
namespace {

constexpr int kInterrupted = 130;

// After a signal that no loop asks for, and after one that is heard.
constexpr std::chrono::seconds kDeaf(5);
constexpr std::chrono::seconds kSlow(60);

std::atomic<int> received{0};
std::atomic<bool> heard{false};

sigset_t all_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    sigaddset(&signals, signal);
  }
  return signals;
}

// Libraries start threads before main() (OpenBLAS does), and a thread that
// leaves a signal unblocked may be given it: they start with the signals
// blocked, the program's own thread allows them again.
void block_before_libraries(int, char**, char**) {
  const sigset_t signals = all_stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}
[[gnu::section(".preinit_array"),
  gnu::used]] void (*const before_libraries)(int, char**,
                                             char**) = block_before_libraries;

[[gnu::constructor]] void allow_after_libraries() {
  const sigset_t signals = all_stop_signals();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

/// The one thread that receives `signals`. After the first it ends the process
/// where the computation does not end by itself: it may stand in a library
/// that nobody can ask to stop. Finished evaluations are in the study's
/// database.
void watch_stop(const sigset_t& signals) {
  using Clock = std::chrono::steady_clock;
  int signal = 0;
  while (sigwait(&signals, &signal) != 0) {
  }
  received = signal;
  const auto begin = Clock::now();
  const timespec moment{.tv_sec = 0, .tv_nsec = 50'000'000};
  while (Clock::now() - begin < (heard ? kSlow : kDeaf)) {
    if (sigtimedwait(&signals, nullptr, &moment) > 0) {
      _exit(kInterrupted);
    }
  }
  const std::string_view text =
      "ended in the middle of a step that does not stop; of a run the finished "
      "evaluations are kept, --resume goes on with them\n";
  [[maybe_unused]] const auto said =
      ::write(STDERR_FILENO, text.data(), text.size());
  _exit(kInterrupted);
}

}  // namespace

void catch_stop_signals() {
  static bool caught = false;
  if (std::exchange(caught, true)) {
    return;
  }
  sigset_t signals = all_stop_signals();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) {
      sigdelset(&signals, signal);
    }
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(watch_stop, signals).detach();
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
