#include "pipeline/case_films/film_start.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/curves/curve.h"
#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_films/film_way.h"

namespace meniscus::case_films {

namespace {

// A curve longer or shorter by more than this asks for other divisions.
constexpr double kLonger = 4.0 / 3.0;
// Films whose areas differ by less are one, on other facets.
constexpr double kSameFilm = 0.05;
// A step that a film does not follow is halved so often.
constexpr int kHalvings = 3;

bool rims_keep_their_size(const films::FilmSystem& before,
                          const films::FilmSystem& after) {
  for (std::size_t k = 0; k < after.curves.size(); ++k) {
    const double ratio = curves::length_of(after.curves[k].shape) /
                         curves::length_of(before.curves[k].shape);
    if (!(ratio < kLonger && ratio > 1.0 / kLonger)) {
      return false;
    }
  }
  return true;
}

/// The next model on a study's way; nothing where the film does not follow.
std::optional<frozen::FilmModel> freeze_next(const frozen::FilmModel& before,
                                             const films::FilmSystem& from,
                                             const films::FilmSystem& system,
                                             frozen::FilmModelOptions options) {
  if (before.reference().failure) {
    return std::nullopt;
  }
  const settle::FilmState state =
      before.settle(system, {.monitor = options.monitor});
  if (state.failure) {
    return std::nullopt;
  }
  if (!rims_keep_their_size(from, system)) {
    frozen::FilmModel anew = frozen::FilmModel::freeze(system, options);
    const settle::FilmState& found = anew.reference();
    if (!found.failure && is_same_film(state.report, found.report)) {
      return anew;
    }
  }
  const films::FilmComplex settled = before.meshed_at(state, system);
  options.start = &settled;
  frozen::FilmModel result = frozen::FilmModel::freeze(system, options);
  if (result.reference().failure) {
    return std::nullopt;
  }
  return result;
}

/// Over designs half-way between, where the film does not follow at once.
std::optional<frozen::FilmModel> lead(const case_data::Case& input,
                                      const frozen::FilmModel& before,
                                      const Waypoint& from, const Waypoint& to,
                                      int halvings,
                                      const frozen::FilmModelOptions& options) {
  std::optional<frozen::FilmModel> next =
      freeze_next(before, from.system, to.system, options);
  if (next || halvings == 0 || before.reference().failure) {
    return next;
  }
  std::optional<frozen::FilmModel> led;
  const std::string prevented = what_prevents([&] {
    const Waypoint middle = waypoint_between(input, from, to);
    std::optional<frozen::FilmModel> half =
        lead(input, before, from, middle, halvings - 1, options);
    if (half) {
      led = lead(input, *half, middle, to, halvings - 1, options);
    }
  });
  return prevented.empty() ? std::move(led) : std::nullopt;
}

void log_lost(const case_data::Case& input,
              const frozen::FilmModelOptions& options) {
  if (!input.way.empty() && options.monitor != nullptr) {
    options.monitor->log(
        Severity::Warning,
        "the film does not follow from where 'start' has it to this design, "
        "nor on the way there: it starts from first facets");
  }
}

}  // namespace

bool is_same_film(const settle::FilmReport& one,
                  const settle::FilmReport& other) {
  return std::abs(one.area - other.area) <= kSameFilm * one.area;
}

case_data::Case frozen_at(case_data::Case input, const VectorX& design) {
  if (design == initial_design(input)) {
    return input;
  }
  input.earlier_freezes.push_back(initial_design(input));
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    input.design[k].initial = design[static_cast<Eigen::Index>(k)];
  }
  return input;
}

frozen::FilmModel freeze_films(const case_data::Case& input,
                               const case_data::EvaluatedCase& inputs,
                               const frozen::FilmModelOptions& options) {
  const std::vector<Waypoint> way = film_way(input, inputs);
  try {
    frozen::FilmModel model =
        frozen::FilmModel::freeze(way.front().system, options);
    for (std::size_t k = 1; k < way.size(); ++k) {
      std::optional<frozen::FilmModel> next =
          lead(input, model, way[k - 1], way[k], kHalvings, options);
      if (!next) {  // as a case of its own
        log_lost(input, options);
        return frozen::FilmModel::freeze(way.back().system, options);
      }
      model = *std::move(next);
    }
    return model;
  } catch (const InvalidInput& error) {
    const std::string message = error.what();
    throw InvalidInput(fmt::format(
        "{}: {}", place(input, case_data::line_of_start(input, message)),
        message));
  }
}

}  // namespace meniscus::case_films
