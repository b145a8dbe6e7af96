/// The fillets of a case on its settled film.
#pragma once

#include <optional>

#include "core/error.h"
#include "evolve/fillets/fillet_model.h"
#include "evolve/frozen/film_model.h"
#include "pipeline/case_data/case.h"

namespace meniscus::forward {

/// Those of a case that has some, on the film `points` of a state of `model`.
/// What does not fit is in `failure`, with the line of `input`, and no model
/// comes back.
std::optional<fillets::FilletModel> fillet_model(
    const case_data::Case& input, const case_data::EvaluatedCase& inputs,
    const frozen::FilmModel& model, const Points& points,
    std::optional<Failure>& failure);

/// That a fillet does not fit, with the line of `input`.
Failure fillet_failure(const case_data::Case& input, const InvalidInput& error);

/// The film's points with fillets that are made anew there; without fillets the
/// points. Throws InvalidInput where one does not fit.
Points rounded_anew(const films::FilmSystem& system,
                    const frozen::FilmModel& model, const Points& points);

}  // namespace meniscus::forward
