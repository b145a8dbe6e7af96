/// What the report page says of a film alone: a folder of `meniscus evolve`.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace meniscus::page {

/// `film`: film.json (pipeline/results/evolved_film.h). Adds to `page`: a
/// `result` with title, units, status and the film's figures, as a run has
/// them; `quantities`, `curves`, `captions` of the frames. Throws
/// Json::exception where it lacks something.
void add_evolved(const nlohmann::ordered_json& film,
                 nlohmann::ordered_json& page);

}  // namespace meniscus::page
