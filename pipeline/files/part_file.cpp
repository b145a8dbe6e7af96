#include "pipeline/files/part_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "evolve/datafile/fe_complex.h"
#include "evolve/datafile/fe_file.h"
#include "io/obj.h"
#include "io/read_stl.h"

namespace meniscus::files {

namespace {

struct PartReader {
  const char* ending;
  SurfaceMesh (*read)(const std::filesystem::path& path,
                      const step::ReadStepOptions& options);
  bool named = true;  // in messages; else another ending of the one before
  bool curved = false;
};

SurfaceMesh stl(const std::filesystem::path& path,
                const step::ReadStepOptions&) {
  return io::read_stl(path);
}

SurfaceMesh obj(const std::filesystem::path& path,
                const step::ReadStepOptions&) {
  return io::read_obj(path);
}

/// All that bounds: films and fixed facets.
SurfaceMesh datafile(const std::filesystem::path& path,
                     const step::ReadStepOptions&) {
  return datafile::complex_of(
             datafile::read_fe(read_file(path), path.filename().string()))
      .mesh;
}

constexpr std::array<PartReader, 5> kReaders = {
    {{".stl", stl},
     {".obj", obj},
     {".step", step::read_step_part, true, true},
     {".stp", step::read_step_part, false, true},
     {".fe", datafile}}};

std::string reader_endings() {
  std::vector<std::string> endings;
  for (const PartReader& reader : kReaders) {
    if (reader.named) {
      endings.emplace_back(reader.ending);
    }
  }
  const std::string last = endings.back();
  endings.pop_back();
  return fmt::format("{} and {}", fmt::join(endings, ", "), last);
}

const PartReader* reader_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  const auto* const reader =
      std::find_if(kReaders.begin(), kReaders.end(),
                   [&](const PartReader& r) { return ending == r.ending; });
  return reader != kReaders.end() ? reader : nullptr;
}

}  // namespace

bool is_part_file(const std::filesystem::path& path) {
  return reader_of(path) != nullptr;
}

bool has_curved_faces(const std::filesystem::path& path) {
  const PartReader* reader = reader_of(path);
  return reader != nullptr && reader->curved;
}

SurfaceMesh read_part_file(const std::filesystem::path& path,
                           const step::ReadStepOptions& options) {
  const PartReader* reader = reader_of(path);
  if (reader == nullptr) {
    throw InvalidInput(fmt::format("{}: no file of a part; there are {}",
                                   path.string(), reader_endings()));
  }
  return reader->read(path, options);
}

}  // namespace meniscus::files
