#include "core/memory.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus::memory_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Memory, OfThisMachineIsKnown) {
  const double free = available_memory();
  EXPECT_GT(free, 1e6);
  EXPECT_LT(free, 1e15);
}

TEST(Memory, WhatDoesNotFitIsSaidBefore) {
  require_memory(1e3, "a drop", "");
  try {
    require_memory(5e18, "the sea", "drink less");
    FAIL() << "it fits";
  } catch (const SolverError& error) {
    EXPECT_THAT(error.what(),
                StartsWith("the sea needs about 5e+09 GB of memory, "));
    EXPECT_THAT(error.what(), HasSubstr(" GB are free; drink less"));
  }
}

}  // namespace
}  // namespace meniscus::memory_test
