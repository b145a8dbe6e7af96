#include "app/signals.h"

#include <chrono>
#include <csignal>
#include <functional>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>
#include <sys/wait.h>

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

TEST(Signals, TheFirstSetsTheFlag) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EQ(exit_code_of([signal] {
                app::catch_stop_signals();
                const bool none = app::stop_signal() == 0;
                raise(signal);
                _exit(none && app::stop_signal() == signal ? 7 : 1);
              }),
              7);
  }
}

TEST(Signals, TheSecondEndsTheProcess) {
  EXPECT_EQ(exit_code_of([] {
              app::catch_stop_signals();
              raise(SIGTERM);
              raise(SIGINT);
            }),
            130);
}

// As in a library that cannot be asked to stop.
TEST(Signals, AStepThatDoesNotHearIsEnded) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(exit_code_of([] {
              app::catch_stop_signals();
              raise(SIGTERM);
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
              raise(SIGHUP);
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
