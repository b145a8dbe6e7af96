#include "core/memory.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

#include <fmt/format.h>
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

class GroupMemory : public ::testing::Test {
 protected:
  GroupMemory() { std::filesystem::create_directories(folder_); }
  ~GroupMemory() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path) << text << '\n';
  }
  double left() const { return group_memory(folder_ / "list", folder_); }

 private:
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                  fmt::format("group_memory_{}", getpid());
};

TEST_F(GroupMemory, IsThatOfTheNarrowestAround) {
  write("list", "0::/job/step");
  EXPECT_EQ(left(), INFINITY);
  write("job/step/memory.max", "max");
  write("job/step/memory.current", "100");
  EXPECT_EQ(left(), INFINITY);
  write("job/memory.max", "5000");
  write("job/memory.current", "3000");
  write("job/memory.stat", "anon 1500\ninactive_file 900\nactive_file 70");
  EXPECT_EQ(left(), 2970.0);
  write("job/step/memory.max", "900");
  EXPECT_EQ(left(), 800.0);
}

TEST_F(GroupMemory, IsReadInTheFirstVersionToo) {
  write("list", "4:cpu:/other\n3:net,memory:/job\n0::/");
  write("memory/job/memory.limit_in_bytes", "7000");
  write("memory/job/memory.usage_in_bytes", "6500");
  write("memory/job/memory.stat", "inactive_file 3\ntotal_inactive_file 20");
  write("memory/other/memory.limit_in_bytes", "1");
  write("memory/other/memory.usage_in_bytes", "1");
  EXPECT_EQ(left(), 520.0);
  write("list", "3:memory:/of/the/host");
  EXPECT_EQ(left(), INFINITY);
  write("memory/memory.limit_in_bytes", "9000");
  write("memory/memory.usage_in_bytes", "1000");
  EXPECT_EQ(left(), 8000.0);
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
