#include "report/page/vtk_bounds.h"

#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/memory.h"
#include "report/page/vtk_input.h"

namespace meniscus::page {

namespace {

// No byte of zlib's output unpacks to more; and what is left of a block.
constexpr std::uint64_t kMostUnpacked = 1040;
constexpr std::uint64_t kLeastUnpacked = 64;

class BoundsCheck {
 public:
  explicit BoundsCheck(const std::filesystem::path& path)
      : path_(path), bytes_(read_file(path)) {}

  void run() {
    const std::string_view all = bytes_;
    const std::size_t appended = all.find("<AppendedData");
    const std::size_t end = all.find_last_not_of(" \t\r\n");
    constexpr std::string_view kEnd = "</VTKFile>";
    if (end == std::string_view::npos ||
        !all.substr(0, end + 1).ends_with(kEnd)) {
      refuse("ends before its end");
    }
    const std::size_t begin = all.find('_', appended);
    if (appended == std::string_view::npos || begin == std::string_view::npos) {
      refuse("has no appended arrays");
    }
    head_ = all.substr(0, appended);
    data_ = all.substr(begin + 1);
    const std::string_view file = tag("<VTKFile", 0);
    word_ = text(file, "header_type") == "UInt64" ? 8 : 4;
    packed_ = !text(file, "compressor").empty();
    add_arrays();
    check_counts();
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    refuse_file(path_, what);
  }

  /// From `from` on, the tag that begins so; empty: none.
  std::string_view tag(std::string_view name, std::size_t from) const {
    const std::size_t at = head_.find(name, from);
    if (at == std::string_view::npos) {
      return {};
    }
    return head_.substr(at, head_.find('>', at) - at);
  }

  static std::string_view text(std::string_view tag, std::string_view name) {
    const std::string key = fmt::format(" {}=\"", name);
    const std::size_t at = tag.find(key);
    if (at == std::string_view::npos) {
      return {};
    }
    const std::string_view rest = tag.substr(at + key.size());
    return rest.substr(0, rest.find('"'));
  }

  std::optional<std::uint64_t> number(std::string_view tag,
                                      std::string_view name) const {
    const std::string_view digits = text(tag, name);
    if (digits.empty()) {
      return std::nullopt;
    }
    std::uint64_t value = 0;
    const auto [stop, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || stop != digits.data() + digits.size()) {
      refuse(
          fmt::format("has a tag with {}=\"{}\"", name, digits.substr(0, 40)));
    }
    return value;
  }

  std::uint64_t word_at(std::uint64_t at) const {
    if (at > data_.size() || data_.size() - at < word_) {
      refuse("is cut off within an array");
    }
    std::uint64_t value = 0;  // this machine's order, as VTK's own
    std::memcpy(&value, data_.data() + at, word_);
    return value;
  }

  /// Bytes of an array once it is unpacked.
  std::uint64_t unpacked(std::uint64_t at) const {
    const std::uint64_t first = word_at(at);
    const std::uint64_t left = data_.size() - at - word_;
    if (!packed_) {
      if (first > left) {
        refuse("is cut off within an array");
      }
      return first;
    }
    if (first == 0) {
      return 0;
    }
    if (first > left / word_ || left / word_ - first < 2) {
      refuse("is cut off within an array");
    }
    const std::uint64_t block = word_at(at + word_);
    const std::uint64_t last = word_at(at + 2 * word_);
    std::uint64_t packed = 0;
    std::uint64_t room = left - (first + 2) * word_;
    for (std::uint64_t k = 0; k < first; ++k) {
      const std::uint64_t size = word_at(at + (3 + k) * word_);
      if (size > room) {
        refuse("is cut off within an array");
      }
      room -= size;
      packed += size;
    }
    const std::uint64_t whole = last > 0 ? first - 1 : first;
    const std::uint64_t most = kMostUnpacked * packed + kLeastUnpacked;
    if (last > most || (whole > 0 && block > (most - last) / whole)) {
      refuse("has an array that claims more than its bytes can hold");
    }
    return whole * block + last;
  }

  void add_arrays() {
    for (std::size_t at = head_.find("Array "); at != std::string_view::npos;
         at = head_.find("Array ", at + 1)) {
      const std::string_view array = head_.substr(at, head_.find('>', at) - at);
      const auto offset = number(array, "offset");
      if (!offset) {
        refuse("has an array that is not appended");
      }
      unpacked_ += unpacked(*offset);
      if (const auto tuples = number(array, "NumberOfTuples")) {
        require_count("values", *tuples);
      }
      constexpr std::uint64_t kMostComponents = 64;
      if (const auto width = number(array, "NumberOfComponents");
          width && *width > kMostComponents) {
        refuse(fmt::format("has an array of {} components", *width));
      }
    }
  }

  void check_counts() {
    std::size_t pieces = 0;
    for (std::size_t at = head_.find("<Piece"); at != std::string_view::npos;
         at = head_.find("<Piece", at + 1), ++pieces) {
      const std::string_view piece = tag("<Piece", at);
      for (const char* name :
           {"NumberOfPoints", "NumberOfCells", "NumberOfVerts", "NumberOfLines",
            "NumberOfStrips", "NumberOfPolys"}) {
        if (const auto count = number(piece, name)) {
          require_count(name, *count);
        }
      }
    }
    constexpr double kCopies = 3.0;  // VTK's, ours as numbers
    const double bytes = kCopies * static_cast<double>(unpacked_);
    if (bytes > available_memory()) {
      refuse(fmt::format("unpacks to {:.2g} GB, more than memory holds",
                         static_cast<double>(unpacked_) / 1e9));
    }
    if (pieces != 1) {
      refuse(fmt::format("has {} pieces, not one", pieces));
    }
  }

  /// Each point, cell or value takes a byte or more somewhere.
  void require_count(const char* what, std::uint64_t count) const {
    if (count > kMostUnpacked * data_.size()) {
      refuse(fmt::format("claims {} {}, more than its bytes can hold", count,
                         what));
    }
    if (std::string_view(what).starts_with("NumberOf") && count > unpacked_) {
      refuse(fmt::format("claims {}=\"{}\", and has arrays of {} bytes in all",
                         what, count, unpacked_));
    }
  }

  const std::filesystem::path& path_;
  std::string bytes_;
  std::string_view head_;
  std::string_view data_;
  std::size_t word_ = 4;
  bool packed_ = false;
  std::uint64_t unpacked_ = 0;  // of all arrays
};

}  // namespace

void check_vtk_bounds(const std::filesystem::path& path) {
  BoundsCheck(path).run();
}

}  // namespace meniscus::page
