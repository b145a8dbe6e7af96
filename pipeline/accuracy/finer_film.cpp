#include "pipeline/accuracy/finer_film.h"

#include <algorithm>

#include "core/error.h"
#include "core/timer.h"
#include "pipeline/case_data/response_kinds.h"
#include "pipeline/forward/frozen_part.h"
#include "pipeline/responses/responses.h"

namespace meniscus::accuracy {

namespace {

bool has_film_figures(const case_data::Case& input) {
  return !input.films.empty() &&
         std::any_of(input.responses.begin(), input.responses.end(),
                     [](const case_data::ResponseEntry& response) {
                       return case_data::row_of(response.kind).of_films;
                     });
}

}  // namespace

FinerFilm evaluate_finer_film(const forward::ForwardModel& model,
                              const VectorX& design, const VectorX& responses,
                              Monitor& monitor) {
  FinerFilm result;
  const case_data::Case& input = model.part().input;
  if (!has_film_figures(input)) {
    return result;
  }
  const Timer timer;
  monitor.progress(
      {.stage = "accuracy", .detail = "the film with edges half as long"});
  // A design's film that is not evaluated has no figures; why is of no use.
  static_cast<void>(what_prevents([&] {
    // 1. The design's film.
    const case_data::EvaluatedCase inputs = case_data::evaluate(input, design);
    const settle::FilmState own =
        model.film().settle(inputs.film_system, {.monitor = &monitor});
    if (own.failure) {
      throw InvalidInput(own.failure->message);
    }
    // 2. On finer facets.
    const frozen::FilmModel finer =
        model.film().refined(own, inputs.film_system, &monitor);
    const settle::FilmState& state = finer.reference();
    if (state.failure) {
      result.is_lost = true;
      throw InvalidInput(state.failure->message);
    }
    // 3. Its figures.
    const TetMesh no_mesh;
    const equations::ElasticSolution no_solution;
    result.responses = responses::respond_films(input,
                                                {.inputs = inputs,
                                                 .mesh = no_mesh,
                                                 .solution = no_solution,
                                                 .excluded = {},
                                                 .film = &finer,
                                                 .film_state = &state,
                                                 .scans = &model.scans()},
                                                responses);
  }));
  result.seconds = timer.seconds();
  return result;
}

}  // namespace meniscus::accuracy
