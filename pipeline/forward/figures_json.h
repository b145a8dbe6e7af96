/// Figures of an evaluation as result.json and the database have them.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "pipeline/case_data/case.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::forward {

/// Each unit by what it is of, of result.json.
nlohmann::ordered_json units_json(const UnitSystem& units);

/// The film's part of result.json.
nlohmann::ordered_json film_json(const settle::FilmReport& film);

/// The films that pops made, a list: `popped` of result.json.
nlohmann::ordered_json popped_json(const settle::FilmReport& film);

nlohmann::ordered_json tet_json(const TetFigures& tet);

nlohmann::ordered_json fea_json(const equations::ElasticReport& fea);

}  // namespace meniscus::forward
