#include "core/math/spilled_matrix.h"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <utility>

#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus::spilled_matrix_test {
namespace {

TEST(SpilledMatrix, ComesBackAsItWas) {
  for (const auto& [rows, columns] :
       {std::pair(1, 1), std::pair(0, 3), std::pair(700, 311)}) {
    const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(rows, columns);
    const SpilledMatrix spilled(matrix);
    EXPECT_EQ(spilled.read(0, columns), matrix);
    EXPECT_EQ(spilled.read(columns / 2, columns - columns / 2),
              matrix.rightCols(columns - columns / 2));
  }
}

TEST(StoredMatrix, IsTheSameOnTheDisk) {
  for (const int columns : {0, 1, 512, 1300}) {
    const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(90, columns);
    for (const bool spill : {false, true}) {
      const StoredMatrix stored(matrix, spill);
      Eigen::MatrixXd read;
      EXPECT_EQ(stored.get(read), matrix);
      Eigen::MatrixXd blocks(90, columns);
      stored.for_each_block([&](Eigen::Index first, const auto& block) {
        blocks.middleCols(first, block.cols()) = block;
      });
      EXPECT_EQ(blocks, matrix);
    }
  }
}

TEST(SpilledMatrix, LeavesNoFileAndSaysWhereThereIsNoFolder) {
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "spilled_matrix_test";
  std::filesystem::create_directory(folder);
  setenv("TMPDIR", folder.c_str(), 1);
  const SpilledMatrix spilled(Eigen::MatrixXd::Ones(9, 9));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::permissions(folder, std::filesystem::perms::owner_read);
  if (geteuid() != 0) {  // who may write anywhere
    EXPECT_THROW(SpilledMatrix(Eigen::MatrixXd::Ones(2, 2)), IoError);
  }
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
  std::filesystem::remove(folder);
  EXPECT_EQ(spilled.read(0, 9).sum(), 81.0);
  if (before == nullptr) {
    unsetenv("TMPDIR");
  } else {
    setenv("TMPDIR", kept.c_str(), 1);
  }
}

}  // namespace
}  // namespace meniscus::spilled_matrix_test
