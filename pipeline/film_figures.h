/// What `meniscus evolve CASE` leaves for programs to read.
#pragma once

#include <filesystem>

#include "evolve/film_model.h"
#include "pipeline/case.h"

namespace meniscus {

/// film.json in `folder`: the figures of result.json's `film` with the area of
/// each film at its own resolution (docs/results.md), units of the case. Throws
/// IoError.
void write_film_figures(const Case& input, const FilmModel& model,
                        const std::filesystem::path& folder);

}  // namespace meniscus
