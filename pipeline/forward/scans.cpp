#include "pipeline/forward/scans.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "pipeline/case_data/content_hash.h"
#include "pipeline/case_data/scan_path.h"
#include "pipeline/forward/part_file.h"

namespace meniscus {

namespace {

std::shared_ptr<const Scan> read_scan(const Case& input,
                                      const ResponseEntry& response) {
  const std::filesystem::path path = scan_path(input, response.scan);
  const auto known = std::find_if(
      input.files.begin(), input.files.end(),
      [&](const CaseFile& file) { return file.path == response.scan; });
  if (known != input.files.end() &&
      known->text != content_hash(read_file(path))) {
    throw InvalidInput(fmt::format(
        "{}: '{}' has changed since the case was read; run it again",
        place(input, response.line), path.string()));
  }
  try {
    return std::make_shared<const Scan>(read_part_file(path, {}));
  } catch (const MeshError& error) {
    throw InvalidInput(fmt::format("{}: '{}': {}", place(input, response.line),
                                   path.string(), error.what()));
  }
}

std::vector<int> labels_of(const FilmModel& film,
                           const std::vector<std::string>& films) {
  const std::vector<std::string>& labels = film.labels();
  std::vector<int> result;
  result.reserve(films.size());
  for (const std::string& name : films) {
    result.push_back(static_cast<int>(
        std::find(labels.begin(), labels.end(), name) - labels.begin()));
  }
  return result;
}

}  // namespace

Scans read_scans(const Case& input) {
  Scans scans;
  for (const ResponseEntry& response : input.responses) {
    if (response.kind == ResponseKind::ScanDistance &&
        scans.count(response.scan) == 0) {
      scans[response.scan] = read_scan(input, response);
    }
  }
  return scans;
}

ScanDistances scan_distances(const ResponseEntry& response, const Scans& scans,
                             const FilmModel& film, const Points& points) {
  return distances_to(*scans.at(response.scan), film.fine_mesh(points),
                      labels_of(film, response.films));
}

}  // namespace meniscus
