#include "pipeline/film_figures.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "pipeline/results.h"

namespace meniscus {

void write_film_figures(const Case& input, const FilmModel& model,
                        const std::filesystem::path& folder) {
  using Json = nlohmann::ordered_json;
  const FilmState& film = model.reference();
  const VectorX areas = model.areas(film.points);
  Json films = Json::object();
  for (std::size_t k = 0; k < model.labels().size(); ++k) {
    const std::string& name = model.labels()[k];
    const bool is_film = std::any_of(
        input.films.begin(), input.films.end(),
        [&](const FilmEntry& entry) { return entry.spec.name == name; });
    if (is_film) {
      films[name] = {{"area", areas[static_cast<Eigen::Index>(k)]}};
    }
  }
  Json json = {{"case", input.title}, {"units", units_json(input.units)}};
  json.update(film_json(film.report));
  json["films"] = films;
  json["seconds"] = film.report.seconds;
  write_file(folder / "film.json", json.dump(2) + "\n");
}

}  // namespace meniscus
