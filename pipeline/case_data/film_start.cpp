#include "pipeline/case_data/film_start.h"

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::case_data {

SourceLine line_of_start(const Case& input, const std::string& message) {
  SourceLine line = 0;
  const auto look = [&](const std::string& name, SourceLine at) {
    const std::size_t found = message.find("'" + name + "'");
    line = line == 0 && found != std::string::npos ? at : line;
  };
  for (const FilmEntry& film : input.films) {
    look(film.spec.name, film.line);
  }
  for (const CapEntry& cap : input.caps) {
    look(cap.spec.name, cap.line);
  }
  for (const BodyEntry& body : input.bodies) {
    if (message.find("body '" + body.name + "'") != std::string::npos) {
      line = body.enclosure_line;
    }
  }
  return line;
}

frozen::FilmModel freeze_films(const Case& input, const EvaluatedCase& inputs,
                               const frozen::FilmModelOptions& options) {
  try {
    return frozen::FilmModel::freeze(inputs.film_system, options);
  } catch (const InvalidInput& error) {
    const std::string message = error.what();
    throw InvalidInput(fmt::format(
        "{}: {}", place(input, line_of_start(input, message)), message));
  }
}

}  // namespace meniscus::case_data
