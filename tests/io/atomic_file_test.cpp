#include "core/atomic_file.h"

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <unistd.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "core/error.h"
#include "io/calculix_inp.h"
#include "io/stl.h"
#include "io/vtk_files.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::atomic_file_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

int files_in(const fs::path& folder) {
  return static_cast<int>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

template <class Action>
std::string io_error_of(const Action& action) {
  try {
    action();
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST(AtomicFile, WritesAndReplacesWholeFiles) {
  const TempFolder folder;
  const fs::path path = folder / "größe und maß.bin";
  const std::string bytes("a\0b\n\xff", 5);
  write_file(path, bytes);
  EXPECT_EQ(read_file(path), bytes);
  write_file(path, "");
  EXPECT_EQ(read_file(path), "");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(AtomicFile, WritesIntoTheWorkingFolder) {
  const TempFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  write_file("plain.txt", "x");
  fs::current_path(before);
  EXPECT_EQ(read_file(folder / "plain.txt"), "x");
}

TEST(AtomicFile, NamesPathReasonAndAdvice) {
  const TempFolder folder;
  EXPECT_THAT(io_error_of([&] { write_file(folder / "no/f.txt", "x"); }),
              testing::AllOf(HasSubstr("no/f.txt"),
                             HasSubstr("No such file or directory"),
                             HasSubstr("make the folder")));
  write_file(folder / "file", "x");
  EXPECT_THAT(
      io_error_of([&] { write_file(folder / "file/below", "x"); }),
      testing::AllOf(HasSubstr("file/below"), HasSubstr("not a folder")));
  EXPECT_THAT(io_error_of([&] { make_folder(folder / "file/below"); }),
              HasSubstr("Not a directory"));
  EXPECT_THAT(io_error_of([&] { write_file(folder.path(), "x"); }),
              HasSubstr("a folder has that name"));
  EXPECT_THAT(io_error_of([&] { read_file(folder / "absent"); }),
              HasSubstr("cannot read"));
  EXPECT_THAT(io_error_of([&] { read_file(folder.path()); }),
              HasSubstr("cannot read"));
  EXPECT_EQ(files_in(folder.path()), 1);
}

// Renaming over it would replace the device for every program of a root user.
TEST(AtomicFile, LeavesDevicesAlone) {
  EXPECT_THAT(io_error_of([] { write_file("/dev/null", "x"); }),
              HasSubstr("/dev/null"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, MakesFoldersThatAreThereAlready) {
  const TempFolder folder;
  make_folder(folder / "a/b c/ü");
  make_folder(folder / "a/b c/ü");
  EXPECT_EQ(files_in(folder / "a/b c/ü"), 0);
}

/// Runs `action` in a child that may write files of 1 kB only; whether it
/// threw an IoError that says so.
template <class Action>
bool fails_cleanly_when_full(const Action& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1024, 1024};
    ::setrlimit(RLIMIT_FSIZE, &small);
    const std::string message = io_error_of(action);
    ::_exit(message.find("File too large") != std::string::npos ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(AtomicFile, KeepsTheOldFileWhenTheDiskIsFull) {
  const TempFolder folder;
  const fs::path path = folder / "state";
  write_file(path, "old");
  EXPECT_TRUE(fails_cleanly_when_full(
      [&] { write_file(path, std::string(100'000, 'x')); }));
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(AtomicFile, LeftoversOfTheDeadAreRemovedAndNoOthers) {
  const TempFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  const std::string dead = fmt::format(".film.vtp.{}-1.tmp", child);
  const std::string alive = fmt::format(".film.vtp.{}-1.tmp", ::getpid());
  for (const std::string& name :
       {dead, alive, std::string("film.vtp"), std::string(".lock")}) {
    std::ofstream(folder / name) << "x";
  }
  remove_leftovers(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / dead));
  EXPECT_TRUE(std::filesystem::exists(folder / alive));
  EXPECT_TRUE(std::filesystem::exists(folder / "film.vtp"));
  EXPECT_TRUE(std::filesystem::exists(folder / ".lock"));
}

TEST(AtomicFile, NoWriterLeavesHalfAFile) {
  const TempFolder folder;
  const SurfaceMesh ball = shapes::sphere(1.0, 3);
  const TetMesh brick = shapes::brick(Vec3(1, 1, 1), 6, 6, 6);
  io::CalculixDeck deck;
  deck.materials = {{"m", 1.0, 0.3, 0.0}};
  EXPECT_TRUE(
      fails_cleanly_when_full([&] { io::write_vtp(folder / "a.vtp", ball); }));
  EXPECT_TRUE(
      fails_cleanly_when_full([&] { io::write_vtu(folder / "a.vtu", brick); }));
  EXPECT_TRUE(fails_cleanly_when_full(
      [&] { io::write_boundary_vtp(folder / "b.vtp", brick); }));
  EXPECT_TRUE(
      fails_cleanly_when_full([&] { io::write_stl(folder / "a.stl", ball); }));
  EXPECT_TRUE(fails_cleanly_when_full(
      [&] { io::write_calculix_inp(folder / "a.inp", brick, deck); }));
  EXPECT_EQ(files_in(folder.path()), 0);
}

}  // namespace
}  // namespace meniscus::atomic_file_test
