#include "io/stl.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "io/atomic_file.h"

namespace meniscus {

namespace {

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kFacetBytes = 50;
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
  std::string header = "meniscus binary STL " + options.name;
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

void check_point(const SurfaceMesh& mesh, std::size_t facet, int id,
                 const std::filesystem::path& path) {
  if (id < 0 || id >= static_cast<int>(mesh.points.size())) {
    throw InvalidInput(
        fmt::format("cannot write '{}': facet {} names point {} of {}",
                    path.string(), facet, id, mesh.points.size()));
  }
  const Vec3& p = mesh.points[static_cast<std::size_t>(id)];
  if (!(p.cwiseAbs().maxCoeff() < std::numeric_limits<float>::max())) {
    throw InvalidInput(fmt::format(
        "cannot write '{}': point {} of facet {} is at ({}, {}, {}), which "
        "STL cannot hold",
        path.string(), id, facet, p.x(), p.y(), p.z()));
  }
}

}  // namespace

void write_stl(const std::filesystem::path& path, const SurfaceMesh& mesh,
               const StlOptions& options) {
  if (mesh.facets.empty()) {
    throw InvalidInput(
        fmt::format("cannot write '{}': the surface is empty", path.string()));
  }
  std::string bytes = make_header(options);
  bytes.reserve(kHeaderBytes + 4 + kFacetBytes * mesh.facets.size());
  append(bytes, static_cast<std::uint32_t>(mesh.facets.size()));
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (const int id : mesh.facets[f]) {
      check_point(mesh, f, id, path);
    }
    append(bytes, area_vector2(mesh, static_cast<int>(f)).stableNormalized());
    for (const int id : mesh.facets[f]) {
      append(bytes, mesh.points[static_cast<std::size_t>(id)]);
    }
    append(bytes, std::uint16_t{0});
  }
  write_file(path, bytes);
}

}  // namespace meniscus
