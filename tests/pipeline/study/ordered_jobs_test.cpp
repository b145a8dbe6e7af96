#include "pipeline/study/ordered_jobs.h"

#include <atomic>
#include <chrono>
#include <numeric>
#include <omp.h>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus::ordered_jobs_test {
namespace {

using std::chrono::milliseconds;

std::vector<int> first(int count) {
  std::vector<int> pieces(count);
  std::iota(pieces.begin(), pieces.end(), 0);
  return pieces;
}

TEST(OrderedJobs, TakesInOrderWhateverEndsFirst) {
  for (const int jobs : {1, 2, 5, study::kMostJobs}) {
    const std::thread::id caller = std::this_thread::get_id();
    std::vector<int> squares(23, -1);
    std::vector<int> taken;
    study::run_in_order({.count = 23,
                         .jobs = jobs,
                         .work =
                             [&](int k) {
                               std::this_thread::sleep_for(milliseconds(k % 3));
                               squares[k] = k * k;
                             },
                         .take =
                             [&](int k) {
                               EXPECT_EQ(std::this_thread::get_id(), caller);
                               EXPECT_EQ(squares[k], k * k);
                               taken.push_back(k);
                             }});
    EXPECT_EQ(taken, first(23)) << jobs;
  }
}

TEST(OrderedJobs, NothingToDoIsDone) {
  study::run_in_order({.count = 0,
                       .jobs = 4,
                       .work = [](int) { FAIL(); },
                       .take = [](int) { FAIL(); }});
}

TEST(OrderedJobs, EachGetsItsShareOfTheThreads) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(7);
  std::vector<int> threads(2);
  // Both wait until the other runs too.
  std::atomic<int> running = 0;
  study::run_in_order({.count = 2,
                       .jobs = 2,
                       .work =
                           [&](int k) {
                             ++running;
                             while (running < 2) {
                               std::this_thread::yield();
                             }
                             threads[k] = omp_get_max_threads();
                           },
                       .take = [](int) {}});
  EXPECT_THAT(threads, testing::Each(3));
  EXPECT_EQ(omp_get_max_threads(), 7);
  omp_set_num_threads(before);
}

TEST(OrderedJobs, WhatIsBeforeAThrowIsTakenAndTheRestToldToEnd) {
  for (const int jobs : {1, 2, 4}) {
    std::vector<int> taken;
    std::atomic<bool> cancelled = false;
    const auto work = [&](int k) {
      if (k == 5) {
        throw std::runtime_error("five");
      }
      if (k > 5) {  // as an evaluation that looks at its monitor
        while (!cancelled) {
          std::this_thread::yield();
        }
        throw Interrupted("stopped");
      }
      std::this_thread::sleep_for(milliseconds(5 - k));
    };
    try {
      study::run_in_order({.count = 9,
                           .jobs = jobs,
                           .work = work,
                           .take = [&](int k) { taken.push_back(k); },
                           .cancel = [&] { cancelled = true; }});
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "five");
    }
    EXPECT_EQ(taken, first(5)) << jobs;
  }
}

TEST(OrderedJobs, WhatTakingThrowsEndsAll) {
  std::atomic<int> begun = 0;
  std::vector<int> taken;
  EXPECT_THROW(
      study::run_in_order({.count = 1000,
                           .jobs = 2,
                           .work =
                               [&](int) {
                                 ++begun;
                                 std::this_thread::sleep_for(milliseconds(1));
                               },
                           .take =
                               [&](int k) {
                                 if (k == 3) {
                                   throw IoError("disk full");
                                 }
                                 taken.push_back(k);
                               }}),
      IoError);
  EXPECT_EQ(taken, first(3));
  EXPECT_LT(begun, 1000);
}

TEST(OrderedJobs, RefusesANumberOfThreadsThatCannotBe) {
  for (const int jobs : {-1, 0, study::kMostJobs + 1}) {
    EXPECT_THROW(study::run_in_order({.count = 1, .jobs = jobs}), InvalidInput);
  }
}

}  // namespace
}  // namespace meniscus::ordered_jobs_test
