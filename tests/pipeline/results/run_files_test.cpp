#include "pipeline/results/run_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "pipeline/results/run_folder.h"
#include "tests/support/case_text.h"
#include "tests/support/temp_folder.h"

namespace meniscus::run_files_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

case_data::Case strut_case() {
  return *reader::read_case_text(strut(), "case.toml").input;
}

void begin_run(const fs::path& folder) {
  results::open_run(strut_case(), folder, results::RunBegins::Anew, "test");
}

TEST(RunFiles, ANewRunTakesAwayWhatTheLastOneOwned) {
  const TempFolder folder;
  begin_run(folder.path());
  const std::vector<std::string> own = {"part.vtu", "part_2.5.stl", "part.png",
                                        "findings.vtp", "part.step"};
  results::claim_files(folder.path(), own);
  for (const std::string& name : own) {
    write_file(folder / name, "old");
  }
  for (const char* name : {"notes.txt", "part_final.stl", "mine.png"}) {
    write_file(folder / name, "the user's");
  }
  begin_run(folder.path());
  for (const std::string& name : own) {
    EXPECT_FALSE(fs::exists(folder / name)) << name;
  }
  for (const char* name : {"notes.txt", "part_final.stl", "mine.png"}) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
}

TEST(RunFiles, AFolderThatNeverHeldARunKeepsItsFiles) {
  const TempFolder folder;
  write_file(folder / "part.png", "the user's");
  write_file(folder / "film.vtp", "the user's");
  begin_run(folder.path());
  EXPECT_EQ(read_file(folder / "part.png"), "the user's");
  EXPECT_EQ(read_file(folder / "film.vtp"), "the user's");
}

TEST(RunFiles, ARunOfAVersionWithoutAListOwnedTheUsualNames) {
  const TempFolder folder;
  begin_run(folder.path());
  fs::remove(folder / results::kRunFilesName);
  write_file(folder / "part.vtu", "old");
  write_file(folder / "part_3.stl", "old or the user's");
  begin_run(folder.path());
  EXPECT_FALSE(fs::exists(folder / "part.vtu"));
  EXPECT_TRUE(fs::exists(folder / "part_3.stl"));
}

TEST(RunFiles, AHostileListReachesNothingElse) {
  const TempFolder folder;
  const fs::path run = folder / "run";
  make_folder(run);
  make_folder(run / "sub");
  write_file(folder / "outside.txt", "the user's");
  write_file(run / "sub" / "inside.txt", "the user's");
  write_file(folder / "target.txt", "the user's");
  fs::create_symlink(folder / "target.txt", run / "link.png");
  write_file(run / results::kRunFilesName,
             "../outside.txt\n" + (folder / "outside.txt").string() +
                 "\nsub\nsub/inside.txt\n.\n..\n\nlink.png\n");
  EXPECT_THAT(results::owned_files(run), ElementsAre("sub", "link.png"));
  results::remove_owned_files(run, true);
  EXPECT_TRUE(fs::exists(folder / "outside.txt"));
  EXPECT_TRUE(fs::exists(run / "sub" / "inside.txt"));
  EXPECT_TRUE(fs::exists(folder / "target.txt"));
  EXPECT_TRUE(fs::is_symlink(run / "link.png"));
  EXPECT_THAT(results::owned_files(run), IsEmpty());
}

TEST(RunFiles, ClaimsAreKeptInOrderAndOnce) {
  const TempFolder folder;
  results::claim_files(folder.path(), {"b.png", "a.png"});
  results::claim_files(folder.path(), {"a.png", "c.png", "x/y.png"});
  EXPECT_THAT(results::owned_files(folder.path()),
              ElementsAre("b.png", "a.png", "c.png"));
}

}  // namespace
}  // namespace meniscus::run_files_test
