#include "app/json_log.h"

#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/json.h"

namespace meniscus::app {

namespace {

using Json = nlohmann::ordered_json;

std::string timestamp() {
  const auto now = std::chrono::system_clock::now();
  const auto milliseconds =
      std::chrono::duration_cast<std::chrono::milliseconds>(
          now.time_since_epoch())
          .count();
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)),
                     milliseconds % 1000);
}

std::string words(int code) {
  return std::error_code(code, std::generic_category()).message();
}

bool write_all(int file, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        ::write(file, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) {
      return false;
    }
    done += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  return true;
}

/// Of a file that ends in the middle of a line.
bool is_cut(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) {
    return false;
  }
  char last = '\n';
  const off_t size = lseek(file, 0, SEEK_END);
  const bool read = size > 0 && pread(file, &last, 1, size - 1) == 1;
  close(file);
  return read && last != '\n';
}

}  // namespace

JsonLog::JsonLog(std::string path) : path_(std::move(path)) {
  const bool cut = is_cut(path_);
  file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) {
    throw IoError(fmt::format(
        "log file '{}' cannot be written: {}; choose another with --log", path_,
        words(errno)));
  }
  if (cut) {
    write_all(file_, "\n");
  }
}

JsonLog::~JsonLog() {
  if (file_ >= 0) {
    close(file_);
  }
}

bool JsonLog::write(const Json& fields) {
  if (file_ < 0) {
    return false;
  }
  Json line = {{"time", timestamp()}};
  line.update(fields);
  if (!write_all(file_, json_line(line) + '\n')) {
    problem_ = words(errno);
    close(file_);
    file_ = -1;
    return false;
  }
  return true;
}

}  // namespace meniscus::app
