/// Same film, same bits: for any number of threads that the environment asks
/// for, in a second run of the same process, and with another film settling in
/// a thread beside it.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/child_process.h"

namespace meniscus::film_bits_test {
namespace {

constexpr int kFilms = 8;  // that film_bits settles

std::string bits_with(const char* threads) {
  const ChildResult run =
      run_child({.argv = {MENISCUS_FILM_BITS},
                 .environment = {{"OMP_NUM_THREADS", threads},
                                 {"OPENBLAS_NUM_THREADS", threads},
                                 {"OMP_DYNAMIC", "false"}},
                 .time_limit = 100.0});
  EXPECT_TRUE(run.succeeded())
      << describe_end(run) << run.output << run.error_tail;
  return run.output;
}

TEST(FilmBits, AreTheSameOnOneAndTwoThreads) {
  const std::string one = bits_with("1");
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), kFilms);
  EXPECT_EQ(one.find("no equilibrium"), std::string::npos) << one;
  EXPECT_EQ(one, bits_with("2"));
}

}  // namespace
}  // namespace meniscus::film_bits_test
