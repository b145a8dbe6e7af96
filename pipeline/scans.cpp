#include "pipeline/scans.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "io/atomic_file.h"
#include "pipeline/content_hash.h"
#include "pipeline/forward_model.h"
#include "pipeline/imported_part.h"

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

std::filesystem::path scan_path(const Case& input, const std::string& scan) {
  return std::filesystem::path(input.path).parent_path() / scan;
}

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

ScanMatch::ScanMatch(const Case& input, const ForwardModel& model, int response)
    : input_(input),
      model_(model),
      response_(input.responses[static_cast<std::size_t>(response)]) {}

const ScanMatch::Settled& ScanMatch::settled(const VectorX& design) {
  if (last_.design.size() != design.size() || last_.design != design) {
    last_.numbers = meniscus::evaluate(input_, design);
    last_.film = model_.film().settle(last_.numbers.film_system);
    last_.distances = scan_distances(response_, model_.scans(), model_.film(),
                                     last_.film.points);
    last_.design = design;
  }
  return last_;
}

VectorX ScanMatch::residuals(const VectorX& design) {
  const VectorX& values = settled(design).distances.values;
  return values / std::sqrt(static_cast<double>(values.size()));
}

JacobianAnswer ScanMatch::jacobian(const VectorX& design) {
  const Settled& at = settled(design);
  JacobianAnswer answer;
  std::vector<FilmSystem> rates;
  rates.reserve(static_cast<std::size_t>(design.size()));
  for (Eigen::Index j = 0; j < design.size(); ++j) {
    rates.push_back(
        meniscus::rates(input_, design, static_cast<int>(j)).film_system);
  }
  const std::vector<int>& vertices = at.distances.vertices;
  const auto count = static_cast<Eigen::Index>(vertices.size());
  answer.jacobian.resize(count, design.size());
  try {
    const std::vector<Points> moves =
        model_.film().tangents(at.film, at.numbers.film_system, rates);
    for (Eigen::Index j = 0; j < design.size(); ++j) {
      const Points& move = moves[static_cast<std::size_t>(j)];
      for (Eigen::Index k = 0; k < count; ++k) {
        const auto row = static_cast<std::size_t>(k);
        answer.jacobian(k, j) =
            at.distances.directions[row].dot(move[vertices[row]]) /
            std::sqrt(static_cast<double>(count));
      }
    }
  } catch (const Error& error) {
    answer.failure = Failure{FailureKind::NotANumber, error.what()};
  }
  return answer;
}

}  // namespace meniscus
