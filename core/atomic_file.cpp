#include "core/atomic_file.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <regex>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "core/error.h"

namespace meniscus {

namespace fs = std::filesystem;

namespace {

const char* advice_for(const std::string& doing, int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free space on that disk or choose a folder on another one";
    case EFBIG:
      return "raise the file size limit (ulimit -f) or write elsewhere";
    case EACCES:
    case EPERM:
      return "check the permissions of file and folder or choose another "
             "folder";
    case EROFS:
      return "that disk is read-only; choose another folder";
    case ENOENT:
      return doing == "read" ? "check the name"
                             : "make the folder first or check the name";
    case ENOTDIR:
      return "a part of the path is a file, not a folder; check the name";
    case EISDIR:
      return "a folder has that name; choose another name";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "check the disk and the path";
  }
}

[[noreturn]] void fail(const std::string& doing, const fs::path& path,
                       int error) {
  throw IoError(describe_io_error(doing, path, error));
}

/// The hidden file beside the target; removed unless it was renamed.
class PendingFile {
 public:
  explicit PendingFile(const fs::path& target) : target_(target) {
    static std::atomic<unsigned> count{0};
    const std::string name =
        fmt::format(".{}.{}-{}.tmp", target.filename().string(), ::getpid(),
                    count.fetch_add(1));
    path_ = target.parent_path() / name;
    // Mode 0666 less the user's umask, as any program's new files have.
    fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd_ < 0) {
      fail("write", target_, errno);
    }
  }
  ~PendingFile() {
    if (fd_ >= 0) {
      ::close(fd_);
    }
    if (!renamed_) {
      ::unlink(path_.c_str());
    }
  }
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
      if (written < 0 && errno != EINTR) {
        fail("write", target_, errno);
      }
      if (written > 0) {
        bytes.remove_prefix(static_cast<std::size_t>(written));
      }
    }
  }

  void publish() {
    if (::fsync(fd_) != 0) {
      fail("write", target_, errno);
    }
    const int fd = std::exchange(fd_, -1);
    if (::close(fd) != 0) {
      fail("write", target_, errno);
    }
    if (::rename(path_.c_str(), target_.c_str()) != 0) {
      fail("write", target_, errno);
    }
    renamed_ = true;
    sync_folder();
  }

 private:
  /// The rename itself survives a power cut; the file is whole either way,
  /// so a file system that cannot do this is no error.
  void sync_folder() const {
    const fs::path folder = target_.parent_path();
    const int fd = ::open(folder.empty() ? "." : folder.c_str(),
                          O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd >= 0) {
      ::fsync(fd);
      ::close(fd);
    }
  }

  fs::path target_, path_;
  int fd_ = -1;
  bool renamed_ = false;
};

}  // namespace

std::string describe_io_error(const std::string& doing, const fs::path& path,
                              int error) {
  return fmt::format("cannot {} '{}': {}; {}", doing, path.string(),
                     std::strerror(error), advice_for(doing, error));
}

void write_file(const fs::path& path, std::string_view bytes) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    fail("write", path, S_ISDIR(status.st_mode) ? EISDIR : EPERM);
  }
  PendingFile file(path);
  file.write(bytes);
  file.publish();
}

void remove_leftovers(const fs::path& folder) {
  static const std::regex hidden(R"(\..+\.([0-9]{1,9})-[0-9]+\.tmp)");
  std::error_code code;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    std::smatch found;
    if (std::regex_match(name, found, hidden) &&
        ::kill(std::stoi(found[1]), 0) != 0 && errno == ESRCH) {
      fs::remove(entry.path(), code);
    }
  }
}

std::string read_file(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) {
    fail("read", path, errno);
  }
  std::string bytes;
  constexpr std::size_t kChunk = 1 << 18;
  int error = 0;
  while (true) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kChunk);
    const ssize_t got = ::read(fd, bytes.data() + before, kChunk);
    error = got < 0 ? errno : 0;
    bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0 || (got < 0 && error != EINTR)) {
      break;
    }
  }
  ::close(fd);
  if (error != 0) {
    fail("read", path, error);
  }
  return bytes;
}

void make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) {
    fail("make the folder", folder, failed.value());
  }
  const PendingFile probe(folder / "probe");
}

}  // namespace meniscus
