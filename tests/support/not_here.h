/// Tests that need what a machine may lack: a peer program, a display server, a
/// locale, an optimised build. By hand they are skipped; scripts/test installs
/// all of it and sets MENISCUS_NO_SKIPS, and what is missing then fails.
#pragma once

#include <cstdlib>

#include <gtest/gtest.h>

namespace meniscus {

inline bool skips_fail() { return std::getenv("MENISCUS_NO_SKIPS") != nullptr; }

}  // namespace meniscus

// Leaves the test (or its SetUp) with `why`.
#define MENISCUS_NOT_HERE(why)      \
  do {                              \
    if (::meniscus::skips_fail()) { \
      FAIL() << (why);              \
    }                               \
    GTEST_SKIP() << (why);          \
  } while (false)
