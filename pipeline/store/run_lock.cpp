#include "pipeline/store/run_lock.h"

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::store {
namespace {

namespace fs = std::filesystem;

// A record lock does not keep its own process out, and closing any descriptor
// of the file drops it: so this process remembers what it holds.
std::mutex held_mutex;
std::set<std::string>& held() {
  static std::set<std::string> paths;
  return paths;
}

std::string words(int code) {
  return std::error_code(code, std::generic_category()).message();
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data()
                                                        : "unknown host";
}

std::string canonical_folder(const std::string& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  const fs::path path = code ? fs::path() : fs::canonical(folder, code);
  if (code || !fs::is_directory(path)) {
    throw IoError(fmt::format(
        "results folder '{}' cannot be used: {}; choose another with --out",
        folder, code ? code.message() : "it is not a folder"));
  }
  return path.string();
}

std::string holder_of(int file) {
  std::array<char, 320> text{};
  const ssize_t size = pread(file, text.data(), text.size() - 1, 0);
  std::string holder(text.data(),
                     size > 0 ? static_cast<std::size_t>(size) : 0);
  while (!holder.empty() && holder.back() == '\n') {
    holder.pop_back();
  }
  return holder.empty() ? "another process" : holder;
}

[[noreturn]] void refuse(const std::string& folder, const std::string& holder) {
  throw InvalidInput(
      fmt::format("another run is at work in '{}' ({}); wait for it, stop it, "
                  "or choose another folder with --out",
                  folder, holder));
}

bool take(int file) {
  struct flock request {};
  request.l_type = F_WRLCK;
  request.l_whence = SEEK_SET;  // from 0, length 0: the whole file
  while (fcntl(file, F_SETLK, &request) != 0) {
    if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::optional<std::string> holder_of_run(const std::string& folder) {
  std::error_code code;
  const fs::path place = fs::canonical(folder, code);
  if (code) {
    return std::nullopt;
  }
  const std::string path = place.string() + "/.lock";
  const std::lock_guard<std::mutex> guard(held_mutex);
  if (held().count(path) != 0) {
    return "this process";
  }
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    return std::nullopt;
  }
  struct flock request {};
  request.l_type = F_WRLCK;
  request.l_whence = SEEK_SET;
  const bool taken =
      fcntl(file, F_GETLK, &request) == 0 && request.l_type != F_UNLCK;
  std::optional<std::string> holder;
  if (taken) {
    holder = holder_of(file);
  }
  close(file);
  return holder;
}

RunLock::RunLock(const std::string& folder)
    : path_(canonical_folder(folder) + "/.lock") {
  const std::lock_guard<std::mutex> guard(held_mutex);
  if (held().count(path_) != 0) {
    refuse(folder, "this process");
  }
  const int file = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) {
    throw IoError(fmt::format(
        "results folder '{}' cannot be written: {}; choose another with --out",
        folder, words(errno)));
  }
  if (!take(file)) {
    const int code = errno;
    const std::string holder = holder_of(file);
    close(file);
    if (code == EACCES || code == EAGAIN) {
      refuse(folder, holder);
    }
    throw IoError(fmt::format(
        "results folder '{}' cannot be locked: {}; its file system may not "
        "support locks, so choose another with --out",
        folder, words(code)));
  }
  const std::string text =
      fmt::format("process {} on {}\n", getpid(), host_name());
  // For people only; the lock itself holds without it, on a full disk too.
  if (ftruncate(file, 0) == 0) {
    [[maybe_unused]] const ssize_t written =
        pwrite(file, text.data(), text.size(), 0);
  }
  held().insert(path_);
  file_ = file;
}

RunLock::~RunLock() { release(); }

RunLock::RunLock(RunLock&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      file_(std::exchange(other.file_, -1)) {}

RunLock& RunLock::operator=(RunLock&& other) noexcept {
  if (this != &other) {
    release();
    path_ = std::exchange(other.path_, {});
    file_ = std::exchange(other.file_, -1);
  }
  return *this;
}

void RunLock::release() noexcept {
  if (file_ < 0) {
    return;
  }
  const std::lock_guard<std::mutex> guard(held_mutex);
  held().erase(path_);
  close(file_);
  file_ = -1;
}

}  // namespace meniscus::store
