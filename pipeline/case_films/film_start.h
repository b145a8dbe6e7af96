/// Films of a case as they start.
#pragma once

#include "evolve/frozen/film_model.h"
#include "pipeline/case_data/case.h"

namespace meniscus::case_films {

/// The case with `design` for its initial one, whose film begins from that of
/// the model before; the case itself where that is its own.
case_data::Case frozen_at(case_data::Case input, const VectorX& design);

/// Films of one design are one film, on other facets, where their areas are
/// within 5 %.
bool is_same_film(const settle::FilmReport& one,
                  const settle::FilmReport& other);

/// FilmModel::freeze() of the case's films; what it refuses is told with the
/// line of the case. After designs of an earlier run or of earlier models
/// (film_way.h) it begins from the film that the model before settles at this
/// design, not from first facets, which may find another film there or none; a
/// step that the film does not follow is halved, three times at most, and after
/// that it begins from first facets all the same, which the monitor hears. Rims
/// keep their divisions on that way: where one is longer or shorter by a third,
/// first facets come first, and count where they lead to the same film
/// (is_same_film). Throws InvalidInput.
frozen::FilmModel freeze_films(const case_data::Case& input,
                               const case_data::EvaluatedCase& inputs,
                               const frozen::FilmModelOptions& options);

}  // namespace meniscus::case_films
