#include "pipeline/responses/scans.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "pipeline/case_data/scan_path.h"
#include "pipeline/files/content_hash.h"
#include "pipeline/files/part_file.h"

namespace meniscus::responses {

namespace {

std::shared_ptr<const scan::Scan> read_scan(
    const case_data::Case& input, const case_data::ResponseEntry& response) {
  const std::filesystem::path path = case_data::scan_path(input, response.scan);
  const auto known = std::find_if(input.files.begin(), input.files.end(),
                                  [&](const case_data::CaseFile& file) {
                                    return file.path == response.scan;
                                  });
  if (known != input.files.end() &&
      known->text != files::content_hash(read_file(path))) {
    throw InvalidInput(fmt::format(
        "{}: '{}' has changed since the case was read; run it again",
        case_data::place(input, response.line), path.string()));
  }
  try {
    return std::make_shared<const scan::Scan>(files::read_part_file(path, {}));
  } catch (const MeshError& error) {
    throw InvalidInput(fmt::format("{}: '{}': {}",
                                   case_data::place(input, response.line),
                                   path.string(), error.what()));
  }
}

std::vector<int> labels_of(const frozen::FilmModel& film,
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

Scans read_scans(const case_data::Case& input) {
  Scans scans;
  for (const case_data::ResponseEntry& response : input.responses) {
    if (response.kind == case_data::ResponseKind::ScanDistance &&
        scans.count(response.scan) == 0) {
      scans[response.scan] = read_scan(input, response);
    }
  }
  return scans;
}

scan::ScanDistances scan_distances(const case_data::ResponseEntry& response,
                                   const Scans& scans,
                                   const frozen::FilmModel& film,
                                   const Points& points) {
  return scan::distances_to(*scans.at(response.scan), film.fine_mesh(points),
                            labels_of(film, response.films));
}

}  // namespace meniscus::responses
