#include "core/frame.h"

#include <cerrno>
#include <fcntl.h>
#include <unistd.h>

namespace meniscus {

namespace {

bool read_bytes(int descriptor, char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t got = ::read(descriptor, data, size);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      return false;
    }
    data += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

std::string framed(std::string_view message) {
  const auto size = static_cast<std::uint64_t>(message.size());
  std::string bytes(reinterpret_cast<const char*>(&size), sizeof size);
  bytes.append(message);
  return bytes;
}

std::optional<std::string> unframed(const std::string& bytes) {
  std::uint64_t size = 0;
  if (bytes.size() < sizeof size) {
    return std::nullopt;
  }
  std::memcpy(&size, bytes.data(), sizeof size);
  if (bytes.size() - sizeof size < size) {
    return std::nullopt;
  }
  return bytes.substr(sizeof size, static_cast<std::size_t>(size));
}

std::optional<std::string> read_frame(int descriptor) {
  std::uint64_t size = 0;
  if (!read_bytes(descriptor, reinterpret_cast<char*>(&size), sizeof size)) {
    return std::nullopt;
  }
  std::string message(static_cast<std::size_t>(size), '\0');
  if (!read_bytes(descriptor, message.data(), message.size())) {
    return std::nullopt;
  }
  return message;
}

bool write_frame(int descriptor, std::string_view message) {
  const std::string bytes = framed(message);
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ssize_t sent = ::write(descriptor, rest.data(), rest.size());
    if (sent < 0 && errno == EINTR) {
      continue;
    }
    if (sent <= 0) {
      return false;
    }
    rest.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

int take_stdout() {
  const int out = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  const int null = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  return out < 0 || null < 0 || ::dup2(null, STDOUT_FILENO) < 0 ? -1 : out;
}

}  // namespace meniscus
