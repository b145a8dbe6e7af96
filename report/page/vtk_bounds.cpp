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
      constexpr std::uint64_t kMostComponents = 64;
      const std::uint64_t width =
          number(array, "NumberOfComponents").value_or(1);
      if (width < 1 || width > kMostComponents) {
        refuse(fmt::format("has an array of {} components", width));
      }
      const std::uint64_t bytes = unpacked(*offset);
      unpacked_ += bytes;
      require_bytes(at, array, bytes);
      if (const auto tuples = number(array, "NumberOfTuples")) {
        require_count("values", *tuples);
      }
    }
  }

  /// Bytes of one value of the array.
  std::uint64_t value_size(std::string_view array) const {
    const std::string_view type = text(array, "type");
    const std::size_t digits = type.find_first_of("0123456789");
    int bits = 0;
    if (digits != std::string_view::npos) {
      std::from_chars(type.data() + digits, type.data() + type.size(), bits);
    }
    if (bits != 8 && bits != 16 && bits != 32 && bits != 64) {
      refuse(fmt::format("has an array of type '{}'", type.substr(0, 40)));
    }
    return static_cast<std::uint64_t>(bits) / 8;
  }

  /// As many as the section of the piece needs that the array stands in: VTK
  /// reads on behind an array that holds fewer.
  void require_bytes(std::size_t at, std::string_view array,
                     std::uint64_t bytes) const {
    struct Section {
      std::string_view open, count, more;
    };
    constexpr Section kSections[] = {
        {"<PointData", "NumberOfPoints", ""},
        {"<Points", "NumberOfPoints", ""},
        {"<CellData", "NumberOfCells", "NumberOfPolys"},
        {"<Cells", "NumberOfCells", ""},
        {"<Verts", "NumberOfVerts", ""},
        {"<Lines", "NumberOfLines", ""},
        {"<Strips", "NumberOfStrips", ""},
        {"<Polys", "NumberOfPolys", ""}};
    const std::size_t piece_at = head_.rfind("<Piece", at);
    if (piece_at == std::string_view::npos) {
      return;  // of the file: texts
    }
    const Section* section = nullptr;
    std::size_t nearest = piece_at;
    for (const Section& s : kSections) {
      const std::size_t open = head_.rfind(s.open, at);
      if (open != std::string_view::npos && open > nearest) {
        nearest = open;
        section = &s;
      }
    }
    if (section == nullptr) {
      return;
    }
    const std::string_view piece = tag("<Piece", piece_at);
    std::uint64_t items = number(piece, section->count).value_or(0);
    if (section->more == "NumberOfPolys" && items == 0) {  // of a surface
      for (const char* kind : {"NumberOfVerts", "NumberOfLines",
                               "NumberOfStrips", "NumberOfPolys"}) {
        items += number(piece, kind).value_or(0);
      }
    }
    const std::string_view name = text(array, "Name");
    const std::uint64_t width = number(array, "NumberOfComponents").value_or(1);
    const std::uint64_t size = width * value_size(array);
    // Corners: as many as the offsets say, one or more of each cell.
    const bool enough = name == "connectivity"
                            ? bytes % size == 0 && bytes / size >= items
                            : bytes / size == items && bytes % size == 0;
    if (!enough) {
      refuse(fmt::format("has {} bytes of '{}' for {} items", bytes,
                         name.substr(0, 40), items));
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
