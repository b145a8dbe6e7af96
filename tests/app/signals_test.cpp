#include "app/signals.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <exception>
#include <functional>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "core/math/linear_solve.h"

namespace meniscus::signals_test {
namespace {

// How a child process that does this ends, as waitpid tells it. A child,
// because the handlers and the flag belong to the whole process.
int status_of(const std::function<void()>& action) {
  const pid_t child = fork();
  if (child == 0) {
    action();
    _exit(99);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

int exit_code_of(const std::function<void()>& action) {
  const int status = status_of(action);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Sent as somebody else would: to the process, not to this thread.
void send(int signal) { ::kill(::getpid(), signal); }

/// The signal shown within 2 s, 0 if none.
int wait_for_signal() {
  for (int k = 0; k < 200 && app::stop_signal() == 0; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return app::stop_signal();
}

TEST(Signals, TheFirstSetsTheFlag) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EQ(exit_code_of([signal] {
                app::catch_stop_signals();
                const bool none = app::stop_signal() == 0;
                send(signal);
                _exit(none && wait_for_signal() == signal ? 7 : 1);
              }),
              7);
  }
}

TEST(Signals, TheSecondEndsTheProcess) {
  EXPECT_EQ(exit_code_of([] {
              app::catch_stop_signals();
              send(SIGTERM);
              wait_for_signal();
              send(SIGINT);
              std::this_thread::sleep_for(std::chrono::seconds(3));
            }),
            130);
}

// METIS has a handler of its own for SIGTERM, which jumps out of its innermost
// call: of whichever thread the signal is given to.
TEST(Signals, NoLibraryTakesThem) {
  constexpr int kSide = 150;
  SparseMatrix grid(kSide * kSide, kSide * kSide);
  for (int k = 0; k < kSide * kSide; ++k) {
    grid.insert(k, k) = 4.0;
    if (k + 1 < kSide * kSide) {
      grid.insert(k + 1, k) = -1.0;
    }
    if (k + kSide < kSide * kSide) {
      grid.insert(k + kSide, k) = -1.0;
    }
  }
  grid.makeCompressed();
  for (int delay = 0; delay < 10; ++delay) {
    EXPECT_EQ(exit_code_of([&] {
                ::alarm(20);  // a lost signal is a failure, not a hang
                app::catch_stop_signals();
                std::atomic<bool> good{true};
                const auto order = [&] {
                  try {
                    while (app::stop_signal() == 0) {
                      nested_dissection(grid);
                    }
                  } catch (const std::exception&) {
                    good = false;
                  }
                };
                std::thread beside(order);
                std::thread sender([delay] {
                  std::this_thread::sleep_for(
                      std::chrono::milliseconds(20 + 7 * delay));
                  send(SIGTERM);
                });
                order();
                beside.join();
                sender.join();
                _exit(good && app::stop_signal() == SIGTERM ? 7 : 1);
              }),
              7);
  }
}

// As in a library that cannot be asked to stop.
TEST(Signals, AStepThatDoesNotHearIsEnded) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(exit_code_of([] {
              app::catch_stop_signals();
              send(SIGTERM);
              for (int k = 0; k < 60; ++k) {
                std::this_thread::sleep_for(std::chrono::seconds(1));
              }
            }),
            130);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(Signals, WhatWasIgnoredStaysIgnored) {
  EXPECT_EQ(exit_code_of([] {
              std::signal(SIGHUP, SIG_IGN);
              app::catch_stop_signals();
              send(SIGHUP);
              std::this_thread::sleep_for(std::chrono::milliseconds(200));
              _exit(app::stop_signal() == 0 ? 7 : 1);
            }),
            7);
}

TEST(Signals, HaveNames) {
  EXPECT_STREQ(app::name_of_signal(SIGINT), "Ctrl-C");
  EXPECT_STREQ(app::name_of_signal(SIGTERM), "SIGTERM");
  EXPECT_STREQ(app::name_of_signal(SIGHUP), "SIGHUP");
}

}  // namespace
}  // namespace meniscus::signals_test
