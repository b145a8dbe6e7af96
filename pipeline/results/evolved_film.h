/// What a folder of `meniscus evolve` says of its film: film.json, for readers
/// and for the report page.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evolve/films/film_complex.h"
#include "evolve/films/nesting.h"
#include "evolve/frozen/film_model.h"
#include "pipeline/case_data/case.h"
#include "pipeline/frames/film_frames.h"

namespace meniscus::results {

/// A boundary curve as the page draws it: two ends of each piece, one after
/// the other [length].
struct CurvePieces {
  std::string name;
  Points ends;
};

struct EvolvedFilm {
  std::string title;
  std::optional<UnitSystem> units;  // none: a datafile has none
  settle::FilmReport report;
  films::NestingReport nesting;
  std::optional<Failure> failure;
  std::vector<std::string> solids;  // surfaces of film.vtp that are no films
  std::vector<std::pair<std::string, double>> areas;  // by film [length^2]
  std::vector<CurvePieces> curves;
  std::vector<std::pair<std::string, double>> quantities;
};

/// The area of each film of the case at rest, at its own resolution.
std::vector<std::pair<std::string, double>> areas_of_films(
    const case_data::Case& input, const frozen::FilmModel& model);

/// How the films of the case at rest lie to each other.
films::NestingReport nesting_of_films(const case_data::Case& input,
                                      const frozen::FilmModel& model);

/// The case's closed curves, in pieces short enough to look smooth.
std::vector<CurvePieces> pieces_of_curves(
    const std::vector<curves::Curve>& curves);

/// The marked edges of a complex that lie on curves: of parametric ones, which
/// know no range of their own, the part that films end on.
std::vector<CurvePieces> pieces_of_curves(const films::FilmComplex& complex);

/// FOLDER/film.json (docs/results.md); `frames`: those of frames.pvd beside
/// it. Throws IoError.
void write_evolved_film(const EvolvedFilm& film,
                        const std::vector<forward::FilmFrame>& frames,
                        const std::filesystem::path& folder);

/// "raw", "step 3", "settled": what a frame of a settling film shows.
std::string settling_caption(const forward::FilmFrame& frame);

}  // namespace meniscus::results
