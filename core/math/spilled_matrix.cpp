#include "core/math/spilled_matrix.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus {

namespace {

[[noreturn]] void refuse(const char* what, const std::string& why) {
  throw IoError(fmt::format(
      "cannot {} {}, where what memory has no room for is kept: {}; set TMPDIR "
      "to a folder with more room, or take a coarser mesh",
      what, std::filesystem::temp_directory_path().string(), why));
}

/// Without a name from the start, or unlinked at once.
std::FILE* unnamed_file() {
  std::string name =
      (std::filesystem::temp_directory_path() / "meniscus-XXXXXX").string();
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) {
    refuse("make a file in", std::strerror(errno));
  }
  unlink(name.c_str());
  std::FILE* file = fdopen(descriptor, "w+b");
  if (file == nullptr) {
    const std::string why = std::strerror(errno);
    close(descriptor);
    refuse("make a file in", why);
  }
  return file;
}

/// As many bytes at a time as the system takes.
template <class Transfer>
void transfer_all(char* data, std::size_t bytes, const char* what,
                  const Transfer& transfer) {
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t count = transfer(data + done, bytes - done, done);
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count <= 0) {
      refuse(what, count < 0 ? std::strerror(errno) : "the file is short");
    }
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace

SpilledMatrix::SpilledMatrix(const Eigen::MatrixXd& matrix)
    : file_(unnamed_file()), rows_(matrix.rows()) {
  const int file = fileno(file_.get());
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-*): the bytes are not changed.
  auto* data = const_cast<char*>(reinterpret_cast<const char*>(matrix.data()));
  transfer_all(data, sizeof(double) * matrix.size(), "write to",
               [&](const char* from, std::size_t count, std::size_t at) {
                 return pwrite(file, from, count, static_cast<off_t>(at));
               });
}

Eigen::MatrixXd SpilledMatrix::read(Eigen::Index first,
                                    Eigen::Index count) const {
  Eigen::MatrixXd matrix(rows_, count);
  const int file = fileno(file_.get());
  const std::size_t start = sizeof(double) * rows_ * first;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast)
  transfer_all(reinterpret_cast<char*>(matrix.data()),
               sizeof(double) * matrix.size(), "read from",
               [&](char* to, std::size_t bytes, std::size_t at) {
                 return pread(file, to, bytes, static_cast<off_t>(start + at));
               });
  return matrix;
}

StoredMatrix::StoredMatrix(Eigen::MatrixXd matrix, bool spill)
    : columns_(matrix.cols()) {
  if (spill) {
    on_disk_.emplace(matrix);
  } else {
    in_memory_ = std::move(matrix);
  }
}

const Eigen::MatrixXd& StoredMatrix::get(Eigen::MatrixXd& read) const {
  if (!on_disk_) {
    return in_memory_;
  }
  read = on_disk_->read(0, columns_);
  return read;
}

}  // namespace meniscus
