/// How a program and its helper tell where a message ends, over pipes on one
/// machine: its length in 8 bytes, then its bytes. And what messages are made
/// of: numbers, texts and arrays without gaps, read back with bounds.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/error.h"

namespace meniscus {

/// A message with its length before it.
std::string framed(std::string_view message);

/// The message that the bytes hold when all of it is there.
std::optional<std::string> unframed(const std::string& bytes);

/// The next message from a file descriptor; nothing at its end. Blocks.
std::optional<std::string> read_frame(int descriptor);

/// False where nobody listens. Blocks.
bool write_frame(int descriptor, std::string_view message);

/// A descriptor of stdout for the helper's answers alone: what libraries print
/// on stdout goes nowhere from then on. Below 0 where there is none.
int take_stdout();

/// Adds values to a message.
class FrameWriter {
 public:
  template <class Value>
  void put(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put_text(std::string_view text) {
    put(static_cast<std::uint64_t>(text.size()));
    bytes_.append(text);
  }
  /// Values that are copied as bytes: numbers, points, triangles.
  template <class Value>
  void put_array(const std::vector<Value>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()),
                  sizeof(Value) * values.size());
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Takes them out again in the same order. Throws IoError where the message
/// ends before, or an array claims more than there is.
class FrameReader {
 public:
  explicit FrameReader(std::string_view bytes) : rest_(bytes) {}

  template <class Value>
  Value get() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value;
    std::memcpy(&value, take(1, sizeof value), sizeof value);
    return value;
  }
  std::string get_text() {
    const auto size = get<std::uint64_t>();
    return {take(size, 1), static_cast<std::size_t>(size)};
  }
  template <class Value>
  std::vector<Value> get_array() {
    const auto size = get<std::uint64_t>();
    const char* from = take(size, sizeof(Value));
    std::vector<Value> values(static_cast<std::size_t>(size));
    if (size > 0) {
      std::memcpy(static_cast<void*>(values.data()), from,
                  sizeof(Value) * values.size());
    }
    return values;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  const char* take(std::uint64_t count, std::size_t size) {
    if (count > rest_.size() / size) {
      throw IoError(
          "a helper program's message was cut off; install program "
          "and helper from one build");
    }
    const char* from = rest_.data();
    rest_.remove_prefix(static_cast<std::size_t>(count) * size);
    return from;
  }

  std::string_view rest_;
};

}  // namespace meniscus
