#include "pipeline/store/run_lock.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>

#include "core/error.h"
#include "tests/support/temp_folder.h"

namespace meniscus::run_lock_test {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& folder) {
  try {
    const store::RunLock lock(folder);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

// A child that takes the lock, tells so, and sleeps until it is killed.
pid_t locked_by_child(const std::string& folder) {
  int ready[2];
  EXPECT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const store::RunLock lock(folder);
    [[maybe_unused]] const ssize_t written = write(ready[1], "!", 1);
    pause();
    _exit(0);
  }
  char byte = 0;
  EXPECT_EQ(read(ready[0], &byte, 1), 1);
  close(ready[0]);
  close(ready[1]);
  return child;
}

TEST(RunLock, RefusesASecondInTheSameProcess) {
  const TempFolder folder;
  {
    store::RunLock lock(folder.path().string());
    EXPECT_THAT(refusal(folder.path().string()), HasSubstr("this process"));
    const store::RunLock moved(std::move(lock));
    EXPECT_NE(refusal(folder.path().string()), "");
  }
  EXPECT_EQ(refusal(folder.path().string()), "");
}

TEST(RunLock, NamesTheProcessThatHasIt) {
  const TempFolder folder;
  const pid_t child = locked_by_child(folder.path().string());
  EXPECT_THAT(refusal(folder.path().string()),
              HasSubstr(fmt::format("process {} on ", child)));
  EXPECT_NE(refusal(folder.path().string()),
            "");  // refusing has not dropped it
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(refusal(folder.path().string()), "");
}

TEST(RunLock, AForkedChildDoesNotKeepIt) {
  const TempFolder folder;
  pid_t child = 0;
  {
    const store::RunLock lock(folder.path().string());
    child = fork();
    if (child == 0) {
      pause();
      _exit(0);
    }
  }
  const pid_t other = locked_by_child(folder.path().string());
  EXPECT_GT(other, 0);
  for (const pid_t pid : {child, other}) {
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
  }
}

TEST(RunLock, MakesTheFolderAndRefusesAFile) {
  const TempFolder folder;
  const std::string inner = folder.path().string() + "/Träger 1/run";
  { const store::RunLock lock(inner); }
  EXPECT_TRUE(std::filesystem::exists(inner + "/.lock"));
  std::ofstream(folder.path().string() + "/file") << "x";
  EXPECT_THROW(store::RunLock(folder.path().string() + "/file"), IoError);
  EXPECT_THROW(store::RunLock(folder.path().string() + "/file/below"), IoError);
}

}  // namespace
}  // namespace meniscus::run_lock_test
