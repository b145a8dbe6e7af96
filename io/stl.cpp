#include "io/stl.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "io/body_surfaces.h"

namespace meniscus::io {

namespace {

constexpr std::size_t kHeaderBytes = 80;
static_assert(std::endian::native == std::endian::little,
              "binary STL is little-endian");

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

void append(std::string& bytes, const Vec3& vector) {
  for (int i = 0; i < 3; ++i) {
    append(bytes, static_cast<float>(vector[i]));
  }
}

/// At most 80 bytes, cut between UTF-8 characters; must not begin with
/// "solid", which readers take for the text format.
std::string make_header(const StlOptions& options) {
  const std::string unit =
      options.unit.empty() ? "" : fmt::format(" unit={}", options.unit);
  std::string header = options.program + ", binary STL: " + options.name;
  const std::size_t room = kHeaderBytes - std::min(unit.size(), kHeaderBytes);
  if (header.size() > room) {
    std::size_t end = room;
    while (end > 0 && (header[end] & 0xC0) == 0x80) {
      --end;
    }
    header.resize(end);
  }
  header += unit;
  header.resize(kHeaderBytes, ' ');
  return header;
}

}  // namespace

void write_stl(const std::filesystem::path& path, const SurfaceMesh& mesh,
               const StlOptions& options) {
  check_for_file(mesh, path, std::numeric_limits<float>::max());
  std::string bytes = make_header(options);
  bytes.reserve(kHeaderBytes + 4 + kStlFacetBytes * mesh.facets.size());
  append(bytes, static_cast<std::uint32_t>(mesh.facets.size()));
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    append(bytes, area_vector2(mesh, static_cast<int>(f)).stableNormalized());
    for (const int id : mesh.facets[f]) {
      append(bytes, mesh.points[static_cast<std::size_t>(id)]);
    }
    append(bytes, std::uint16_t{0});
  }
  write_file(path, bytes);
}

}  // namespace meniscus::io
