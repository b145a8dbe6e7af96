#include "pipeline/study/scan_match.h"

#include <cmath>

namespace meniscus::study {

ScanMatch::ScanMatch(const case_data::Case& input,
                     const forward::ForwardModel& model, int response)
    : input_(input),
      model_(model),
      response_(input.responses[static_cast<std::size_t>(response)]) {}

const ScanMatch::Settled& ScanMatch::settled(const VectorX& design) {
  if (last_.design.size() != design.size() || last_.design != design) {
    last_.inputs = meniscus::case_data::evaluate(input_, design);
    last_.film = model_.film().settle(last_.inputs.film_system);
    last_.distances = responses::scan_distances(
        response_, model_.scans(), model_.film(), last_.film.points);
    last_.design = design;
  }
  return last_;
}

VectorX ScanMatch::residuals(const VectorX& design) {
  const VectorX& values = settled(design).distances.values;
  return values / std::sqrt(static_cast<double>(values.size()));
}

optimize::JacobianAnswer ScanMatch::jacobian(const VectorX& design) {
  const Settled& at = settled(design);
  optimize::JacobianAnswer answer;
  std::vector<films::FilmSystem> rates;
  rates.reserve(static_cast<std::size_t>(design.size()));
  for (Eigen::Index j = 0; j < design.size(); ++j) {
    rates.push_back(
        meniscus::case_data::rates(input_, design, static_cast<int>(j))
            .film_system);
  }
  const std::vector<int>& vertices = at.distances.vertices;
  const auto count = static_cast<Eigen::Index>(vertices.size());
  answer.jacobian.resize(count, design.size());
  try {
    const std::vector<Points> moves =
        model_.film().tangents(at.film, at.inputs.film_system, rates);
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

}  // namespace meniscus::study
