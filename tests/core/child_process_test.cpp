#include "core/child_process.h"

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <signal.h>
#include <thread>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/find_program.h"

namespace meniscus::child_process_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

ChildOptions shell(const std::string& script) {
  ChildOptions options;
  options.argv = {"sh", "-c", script};
  return options;
}

TEST(ChildProcess, PassesBinaryBytesBothWays) {
  std::string bytes(3'000'000, '\0');  // larger than any pipe's buffer
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<char>(i * 2654435761u >> 13);
  }
  ChildOptions options;
  options.argv = {"cat"};
  options.input = bytes;
  const ChildResult result = run_child(options);
  EXPECT_TRUE(result.succeeded());
  EXPECT_TRUE(result.output == bytes);
}

TEST(ChildProcess, ReportsExitCodeAndTheEndOfStderr) {
  ChildOptions options =
      shell("yes waffle | head -c 100000 >&2; echo end >&2; exit 7");
  options.error_tail = 10;
  const ChildResult result = run_child(options);
  EXPECT_EQ(result.exit_code, 7);
  EXPECT_EQ(result.signal, 0);
  EXPECT_FALSE(result.succeeded());
  EXPECT_EQ(result.error_tail.size(), 10u);
  EXPECT_THAT(result.error_tail, ::testing::EndsWith("end\n"));
  EXPECT_THAT(describe_end(result), HasSubstr("exit code 7"));
}

TEST(ChildProcess, ReportsTheSignalOfACrash) {
  const ChildResult result = run_child(shell("kill -SEGV $$"));
  EXPECT_EQ(result.signal, SIGSEGV);
  EXPECT_EQ(result.exit_code, -1);
  EXPECT_THAT(describe_end(result), HasSubstr("signal 11"));
}

TEST(ChildProcess, SurvivesAChildThatDoesNotReadItsInput) {
  const std::string bytes(1'000'000, 'x');
  ChildOptions options = shell("exit 3");
  options.input = bytes;
  EXPECT_EQ(run_child(options).exit_code, 3);
}

TEST(ChildProcess, KillsAtTheTimeLimitWithEverythingTheChildStarted) {
  ChildOptions options = shell("sleep 60 & sleep 60");
  options.time_limit = 0.2;
  const ChildResult result = run_child(options);
  EXPECT_TRUE(result.timed_out);
  EXPECT_LT(result.seconds, 5.0);
}

TEST(ChildProcess, DoesNotWaitForGrandchildrenThatHoldTheStreams) {
  const ChildResult result = run_child(shell("sleep 60 & exit 0"));
  EXPECT_TRUE(result.succeeded());
  EXPECT_LT(result.seconds, 5.0);
}

TEST(ChildProcess, StopsWhenTheMonitorAsks) {
  struct Stopper : Monitor {
    bool stop_requested() const override { return true; }
  } stopper;
  ChildOptions options = shell("sleep 60");
  options.monitor = &stopper;
  const ChildResult result = run_child(options);
  EXPECT_TRUE(result.stopped);
  EXPECT_LT(result.seconds, 5.0);
}

TEST(ChildProcess, HoldsTheMemoryLimit) {
  ChildOptions options = shell("ulimit -v");
  options.memory_limit = 512.0 * 1024 * 1024;
  EXPECT_EQ(run_child(options).output, "524288\n");
}

TEST(ChildProcess, SetsAndRemovesVariablesAndTheFolder) {
  ::setenv("MENISCUS_TEST_A", "old", 1);
  ::setenv("MENISCUS_TEST_B", "old", 1);
  ChildOptions options =
      shell("echo \"$MENISCUS_TEST_A,${MENISCUS_TEST_B-unset}\"; pwd");
  options.environment = {{"MENISCUS_TEST_A", "new"},
                         {"MENISCUS_TEST_B", std::nullopt}};
  options.folder = "/";
  EXPECT_EQ(run_child(options).output, "new,unset\n/\n");
}

TEST(ChildProcess, NamesAProgramThatCannotBeStarted) {
  ChildOptions options;
  options.argv = {"no-such-program-here"};
  try {
    run_child(options);
    FAIL() << "no exception";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no-such-program-here"));
  }
  const fs::path broken = fs::temp_directory_path() / "meniscus_broken_helper";
  std::ofstream(broken) << "#!/no/such/interpreter\n";
  fs::permissions(broken, fs::perms::owner_all);
  options.argv = {broken.string()};
  EXPECT_THROW(run_child(options), IoError);
  fs::remove(broken);
}

TEST(ChildProcess, RunsFromSeveralThreadsAtOnce) {
  std::vector<std::thread> threads;
  std::vector<std::string> outputs(8);
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([i, &outputs] {
      outputs[i] = run_child(shell("echo " + std::to_string(i))).output;
    });
  }
  for (int i = 0; i < 8; ++i) {
    threads[i].join();
    EXPECT_EQ(outputs[i], std::to_string(i) + "\n");
  }
}

// A reply that arrives while the caller's wait for it runs out, from many
// callers on few cores: none is lost.
TEST(ChildProcess, KeepsWhatWasWrittenJustBeforeTheEnd) {
  constexpr int kCallers = 16;
  constexpr int kRuns = 12;
  std::atomic<int> lost = 0;
  std::vector<std::thread> callers;
  callers.reserve(kCallers);
  for (int c = 0; c < kCallers; ++c) {
    callers.emplace_back([&lost] {
      for (int i = 0; i < kRuns; ++i) {
        const ChildResult result = run_child(shell("sleep 0.05; echo here"));
        lost += result.output == "here\n" ? 0 : 1;
      }
    });
  }
  for (std::thread& caller : callers) {
    caller.join();
  }
  EXPECT_EQ(lost, 0);
}

TEST(BackgroundChild, TalksAndEndsWithItsOwner) {
  pid_t process = 0;
  {
    BackgroundChild child(shell("echo $$; exec sleep 60"));
    const auto line = child.read_line(5.0);
    ASSERT_TRUE(line);
    process = std::stoi(*line);
    EXPECT_EQ(::kill(process, 0), 0);
    EXPECT_FALSE(child.read_line(0.05));
  }
  EXPECT_NE(::kill(process, 0), 0);
}

TEST(FindHelper, LooksBesideTheProgramAndObeysTheVariable) {
  const fs::path self = fs::read_symlink("/proc/self/exe");
  ::unsetenv("MENISCUS_TEST_HELPER");
  const std::string variable = "MENISCUS_TEST_HELPER";
  EXPECT_EQ(find_helper(self.filename(), variable), self);
  EXPECT_FALSE(find_helper("no-such-helper", variable));
  ::setenv("MENISCUS_TEST_HELPER", "/bin/sh", 1);
  EXPECT_EQ(find_helper(self.filename(), variable), fs::path("/bin/sh"));
  ::setenv("MENISCUS_TEST_HELPER", "/no/such/file", 1);
  EXPECT_FALSE(find_helper(self.filename(), variable));
}

TEST(FindHelper, SaysWhereItLooked) {
  const auto says = [](const std::string& name) {
    try {
      return require_helper(name, "MENISCUS_TEST_HELPER", "build it again");
    } catch (const IoError& error) {
      return std::string(error.what());
    }
  };
  const fs::path self = fs::read_symlink("/proc/self/exe");
  ::setenv("MENISCUS_TEST_HELPER", "/no/such/file", 1);
  EXPECT_THAT(says("helper"), testing::HasSubstr("says '/no/such/file'"));
  ::unsetenv("MENISCUS_TEST_HELPER");
  EXPECT_EQ(says(self.filename()), self);
  EXPECT_THAT(
      says("no-such-helper"),
      testing::AllOf(
          testing::HasSubstr((self.parent_path() / "no-such-").string()),
          testing::HasSubstr("libexec/meniscus/no-such-helper"),
          testing::EndsWith("build it again")));
}

}  // namespace
}  // namespace meniscus::child_process_test
