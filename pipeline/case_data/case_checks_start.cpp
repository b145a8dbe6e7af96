/// Checks of what films of facets start from.
#include <algorithm>

#include "core/error.h"
#include "evolve/start/start_complex.h"
#include "evolve/start/start_edge.h"
#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/film_start.h"

namespace meniscus::case_data {

bool has_facets(const Case& input) {
  return std::any_of(input.films.begin(), input.films.end(),
                     [](const FilmEntry& film) {
                       return film.spec.kind == films::FilmKind::Facets;
                     }) ||
         std::any_of(input.caps.begin(), input.caps.end(),
                     [](const CapEntry& cap) { return cap.is_file; });
}

bool has_facets(const Case& input, const BodyEntry& body) {
  const auto encloses = [&](const std::string& name) {
    return std::find(body.enclosed_by.begin(), body.enclosed_by.end(), name) !=
           body.enclosed_by.end();
  };
  return std::any_of(input.films.begin(), input.films.end(),
                     [&](const FilmEntry& film) {
                       return film.spec.kind == films::FilmKind::Facets &&
                              encloses(film.spec.name);
                     }) ||
         std::any_of(input.caps.begin(), input.caps.end(),
                     [&](const CapEntry& cap) {
                       return cap.is_file && encloses(cap.spec.name);
                     });
}

void check_start(const Case& input, const EvaluatedCase& inputs,
                 CaseProblems& problems) {
  if (!has_facets(input)) {
    return;
  }
  try {
    start::build_start(inputs.film_system,
                       start::start_edge(inputs.film_system, inputs.fea_edge));
  } catch (const Error& error) {
    const std::string message = error.what();
    problems.add(line_of_start(input, message), message);
  }
}

}  // namespace meniscus::case_data
