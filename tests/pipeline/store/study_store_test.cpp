#include "pipeline/store/study_store.h"

#include <bit>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <thread>
#include <unistd.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "tests/support/temp_folder.h"

namespace meniscus::study_store_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

const store::StudyMeta kMeta = {.program_version = "0.1.0",
                                .case_hash = "abc",
                                .case_text = "title = \"Träger\"\n",
                                .created = ""};

VectorX pair(double a, double b) {
  VectorX values(2);
  values << a, b;
  return values;
}

store::EvaluationRecord record_of(int i) {
  store::EvaluationRecord record;
  record.phase = "step";
  record.input_names = {"support_x", "height"};
  record.inputs = pair(0.1 * i, 1.0 / (i + 3.0));
  record.response_names = {"left"};
  record.responses = VectorX::Constant(1, std::sqrt(2.0 + i));
  record.mismatch = 0.5 / i;
  record.figures = R"({"film": {"vertices": 12}})";
  record.seconds = {{"film", 0.25}, {"fea", 0.5}};
  return record;
}

std::string file_of(const TempFolder& folder) {
  return folder.path().string() + "/study.sqlite";
}

std::string contents(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

template <typename Expected, typename Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Expected& error) {
    return error.what();
  }
  return "nothing thrown";
}

void run_sql(const std::string& path, const char* sql) {
  sqlite3* handle = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &handle), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(handle, sql, nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(handle);
  sqlite3_close(handle);
}

TEST(StudyStore, BringsBackTheSameBits) {
  const TempFolder folder;
  store::EvaluationRecord record = record_of(1);
  record.inputs = pair(5e-324, -1.0 / 3.0);
  record.responses[0] = std::numeric_limits<double>::max();
  record.gradient = pair(0.1, std::nextafter(0.2, 1.0)).transpose();
  store::EvaluationRecord failed = record_of(2);
  failed.responses.resize(0);
  failed.mismatch.reset();
  failed.failure = Failure{FailureKind::FilmPinched, "neck at (1, 2, 3)"};
  {
    store::StudyStore store =
        store::StudyStore::start(folder.path().string(), kMeta);
    EXPECT_EQ(store.append(record), 1);
    EXPECT_EQ(store.append(failed), 2);
  }
  const store::StudyStore store =
      store::StudyStore::read(folder.path().string());
  EXPECT_EQ(store.meta().case_text, kMeta.case_text);
  EXPECT_EQ(store.meta().schema_version, 2);
  EXPECT_EQ(store.meta().created.size(), 20U) << store.meta().created;
  const std::vector<store::EvaluationRecord> all = store.all();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].number, 1);
  EXPECT_EQ(all[0].input_names, record.input_names);
  EXPECT_EQ(all[0].inputs, record.inputs);
  EXPECT_EQ(all[0].responses, record.responses);
  EXPECT_EQ(all[0].gradient, record.gradient);
  EXPECT_EQ(all[0].mismatch, record.mismatch);
  EXPECT_EQ(all[0].figures, record.figures);
  EXPECT_EQ(all[0].seconds, record.seconds);
  EXPECT_EQ(all[0].phase, "step");
  EXPECT_FALSE(all[0].failure);
  ASSERT_TRUE(all[1].failure);
  EXPECT_EQ(all[1].failure->kind, FailureKind::FilmPinched);
  EXPECT_EQ(all[1].failure->message, "neck at (1, 2, 3)");
  EXPECT_EQ(all[1].responses.size(), 0);
  EXPECT_FALSE(all[1].mismatch);
}

TEST(StudyStore, FindsByExactBitsOnly) {
  const TempFolder folder;
  store::StudyStore store =
      store::StudyStore::start(folder.path().string(), kMeta);
  store::EvaluationRecord record = record_of(1);
  record.inputs = pair(0.0, 0.3);
  store.append(record);
  EXPECT_TRUE(store.find("base", record.inputs));
  EXPECT_TRUE(store.find("base", pair(-0.0, 0.3)));
  EXPECT_FALSE(store.find("base", pair(0.0, std::nextafter(0.3, 1.0))));
  EXPECT_FALSE(store.find("coarse", record.inputs));
  EXPECT_FALSE(store.find("base", VectorX::Zero(1)));
}

TEST(StudyStore, GivesRecordsByNumberInTheOrderAskedFor) {
  const TempFolder folder;
  store::StudyStore store =
      store::StudyStore::start(folder.path().string(), kMeta);
  for (int i = 1; i <= 3; ++i) {
    store.append(record_of(i));
  }
  const std::vector<store::EvaluationRecord> some = store.some({3, 1});
  ASSERT_EQ(some.size(), 2);
  EXPECT_EQ(some[0].number, 3);
  EXPECT_EQ(some[0].responses, record_of(3).responses);
  EXPECT_EQ(some[1].inputs, record_of(1).inputs);
  EXPECT_THAT(message_of<InvalidInput>([&] {
                store.some({1, 4});
              }),
              HasSubstr("no record 4"));
}

TEST(StudyStore, ResumesWhatIsThereOrStarts) {
  const TempFolder folder;
  {
    store::StudyStore::resume(folder.path().string(), kMeta)
        .append(record_of(1));
  }
  store::StudyStore store =
      store::StudyStore::resume(folder.path().string(), kMeta);
  EXPECT_EQ(store.size(), 1);
  EXPECT_EQ(store.append(record_of(2)), 2);
}

TEST(StudyStore, RefusesToResumeAnotherCase) {
  const TempFolder folder;
  {
    store::StudyStore::start(folder.path().string(), kMeta)
        .append(record_of(1));
  }
  store::StudyMeta other = kMeta;
  other.case_hash = "xyz";
  EXPECT_THAT(
      message_of<InvalidInput>(
          [&] { store::StudyStore::resume(folder.path().string(), other); }),
      AllOf(HasSubstr("another case"), HasSubstr("abc"), HasSubstr("xyz")));
  EXPECT_EQ(store::StudyStore::read(folder.path().string()).size(), 1);
}

TEST(StudyStore, StartKeepsOlderStudies) {
  const TempFolder folder;
  for (int i = 1; i <= 3; ++i) {
    store::StudyStore store =
        store::StudyStore::start(folder.path().string(), kMeta);
    EXPECT_EQ(store.size(), 0);
    for (int k = 0; k < i; ++k) {
      store.append(record_of(k + 1));
    }
  }
  EXPECT_EQ(store::StudyStore::read(folder.path().string()).size(), 3);
  for (int i = 1; i <= 2; ++i) {
    const TempFolder copy;
    fs::copy(fmt::format("{}/study-{}.sqlite", folder.path().string(), i),
             file_of(copy));
    EXPECT_EQ(store::StudyStore::read(copy.path().string()).size(), i);
  }
}

TEST(StudyStore, TwoRunsInOneFolderAreRefused) {
  const TempFolder folder;
  store::StudyStore store =
      store::StudyStore::start(folder.path().string(), kMeta);
  EXPECT_THAT(message_of<InvalidInput>([&] {
                store::StudyStore::start(folder.path().string(), kMeta);
              }),
              HasSubstr("another run"));
  EXPECT_THROW(store::StudyStore::resume(folder.path().string(), kMeta),
               InvalidInput);
  EXPECT_EQ(store.append(record_of(1)), 1);
}

TEST(StudyStore, CanBeReadWhileARunWrites) {
  const TempFolder folder;
  store::StudyStore store =
      store::StudyStore::start(folder.path().string(), kMeta);
  store.append(record_of(1));
  store::StudyStore reader = store::StudyStore::read(folder.path().string());
  EXPECT_EQ(reader.size(), 1);
  store.append(record_of(2));
  EXPECT_EQ(reader.size(), 2);
  EXPECT_THROW(reader.append(record_of(3)), InvalidInput);
  EXPECT_THAT(message_of<IoError>([&] {
                store::StudyStore::read(folder.path().string() + "/none");
              }),
              HasSubstr("no study"));
}

// Writes records until it is killed, telling each number once it is stored.
[[noreturn]] void write_forever(const std::string& folder, int pipe_end) {
  store::StudyStore store = store::StudyStore::resume(folder, kMeta);
  for (int i = store.size() + 1;; ++i) {
    const int number = store.append(record_of(i));
    if (write(pipe_end, &number, sizeof number) != sizeof number) {
      _exit(1);
    }
  }
}

TEST(StudyStore, KillLosesNothingFinished) {
  const TempFolder folder;
  int before = 0;
  for (int round = 0; round < 12; ++round) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      write_forever(folder.path().string(), ends[1]);
    }
    close(ends[1]);
    // From the creation of the file to the middle of the work.
    std::this_thread::sleep_for(std::chrono::milliseconds(7 * round + 1));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    int told = before;
    for (int number = 0; read(ends[0], &number, sizeof number) > 0;) {
      EXPECT_EQ(number, told + 1);
      told = number;
    }
    close(ends[0]);
    const store::StudyStore store =
        store::StudyStore::resume(folder.path().string(), kMeta);
    const std::vector<store::EvaluationRecord> all = store.all();
    // The one under way when the kill came may be there or not.
    EXPECT_GE(static_cast<int>(all.size()), told);
    EXPECT_LE(static_cast<int>(all.size()), told + 1);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const store::EvaluationRecord expected =
          record_of(static_cast<int>(i) + 1);
      EXPECT_EQ(all[i].inputs, expected.inputs);
      EXPECT_EQ(all[i].responses, expected.responses);
    }
    before = static_cast<int>(all.size());
  }
  EXPECT_GT(before, 0);
}

TEST(StudyStore, ADamagedFileIsNamedAndLeftAlone) {
  const TempFolder folder;
  const std::string garbage(5000, '\x5a');
  std::ofstream(file_of(folder), std::ios::binary) << garbage;
  EXPECT_THAT(message_of<IoError>([&] {
                store::StudyStore::resume(folder.path().string(), kMeta);
              }),
              AllOf(HasSubstr("study.sqlite is damaged"), HasSubstr("left")));
  EXPECT_THROW(store::StudyStore::read(folder.path().string()), IoError);
  EXPECT_EQ(contents(file_of(folder)), garbage);
  EXPECT_EQ(store::StudyStore::start(folder.path().string(), kMeta)
                .append(record_of(1)),
            1);
  EXPECT_EQ(contents(folder.path().string() + "/study-1.sqlite"), garbage);
}

TEST(StudyStore, ATruncatedFileIsNamedAndLeftAlone) {
  const TempFolder folder;
  {
    store::StudyStore store =
        store::StudyStore::start(folder.path().string(), kMeta);
    for (int i = 1; i <= 100; ++i) {
      store.append(record_of(i));
    }
  }
  fs::resize_file(file_of(folder), fs::file_size(file_of(folder)) / 2);
  const std::string half = contents(file_of(folder));
  EXPECT_THAT(message_of<IoError>([&] {
                store::StudyStore::resume(folder.path().string(), kMeta);
              }),
              HasSubstr("damaged"));
  EXPECT_EQ(contents(file_of(folder)), half);
}

TEST(StudyStore, AnEmptyFileIsAsGoodAsNone) {
  const TempFolder folder;
  std::ofstream(file_of(folder), std::ios::binary) << "";
  EXPECT_THAT(message_of<IoError>(
                  [&] { store::StudyStore::read(folder.path().string()); }),
              HasSubstr("no study yet"));
  EXPECT_EQ(store::StudyStore::resume(folder.path().string(), kMeta)
                .append(record_of(1)),
            1);
}

TEST(StudyStore, AnotherVersionOrProgramIsRefusedByName) {
  const TempFolder folder;
  EXPECT_EQ(store::StudyStore::start(folder.path().string(), kMeta)
                .append(record_of(1)),
            1);
  run_sql(file_of(folder), "PRAGMA user_version = 7");
  EXPECT_THAT(message_of<InvalidInput>([&] {
                store::StudyStore::resume(folder.path().string(), kMeta);
              }),
              AllOf(HasSubstr("schema version 7"), HasSubstr("version 2")));
  EXPECT_THROW(store::StudyStore::read(folder.path().string()), InvalidInput);

  const TempFolder foreign;
  run_sql(file_of(foreign), "CREATE TABLE birds (name TEXT)");
  EXPECT_THAT(message_of<InvalidInput>([&] {
                store::StudyStore::resume(foreign.path().string(), kMeta);
              }),
              HasSubstr("another program"));
}

TEST(StudyStore, ALockedDatabaseIsWaitedForAndThenNamed) {
  const TempFolder folder;
  store::StudyStore store = store::StudyStore::start(
      folder.path().string(), kMeta, {.busy_timeout = 0.05});
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(file_of(folder).c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr),
            SQLITE_OK);
  EXPECT_THAT(message_of<IoError>([&] { store.append(record_of(1)); }),
              AllOf(HasSubstr("locked"), HasSubstr("0.05 s")));
  sqlite3_exec(other, "ROLLBACK", nullptr, nullptr, nullptr);
  sqlite3_close(other);
  EXPECT_EQ(store.append(record_of(1)), 1);
}

TEST(StudyStore, AFullDiskIsNamedAndKeepsWhatIsFinished) {
  const TempFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    // A limit on file size stands in for the disk: the kernel refuses to
    // write, with EFBIG instead of ENOSPC.
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{200000, 200000};
    setrlimit(RLIMIT_FSIZE, &limit);
    store::StudyStore store =
        store::StudyStore::start(folder.path().string(), kMeta);
    store::EvaluationRecord record = record_of(1);
    const std::string message = message_of<IoError>([&] {
      for (int i = 1; i < 10000; ++i) {
        record.phase = std::to_string(i);
        store.append(record);
      }
    });
    _exit(message.find("disk full while writing") == 0 &&
                  message.find("study.sqlite") != std::string::npos
              ? 0
              : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  const store::StudyStore store =
      store::StudyStore::resume(folder.path().string(), kMeta);
  EXPECT_GT(store.size(), 20);
}

TEST(StudyStore, RefusesARecordThatDoesNotFit) {
  const TempFolder folder;
  store::StudyStore store =
      store::StudyStore::start(folder.path().string(), kMeta);
  store::EvaluationRecord record = record_of(1);
  record.inputs.conservativeResize(1);
  EXPECT_THROW(store.append(record), InvalidInput);
  record = record_of(1);
  record.responses.resize(0);
  EXPECT_THROW(store.append(record), InvalidInput);
  EXPECT_EQ(store.size(), 0);
}

TEST(StudyStore, FailureKindsHaveNamesBothWays) {
  for (int i = 0; i <= static_cast<int>(FailureKind::NotANumber); ++i) {
    const auto kind = static_cast<FailureKind>(i);
    EXPECT_EQ(store::failure_kind_of(name_of(kind)), kind);
  }
  EXPECT_THROW(store::failure_kind_of("gone"), IoError);
}

}  // namespace
}  // namespace meniscus::study_store_test
