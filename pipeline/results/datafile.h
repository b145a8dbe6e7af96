/// Surface Evolver datafiles through the program: read, settled, written.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evolve/datafile/fe_complex.h"
#include "evolve/films/nesting.h"
#include "evolve/frozen/film_model.h"
#include "evolve/settle/descent.h"

namespace meniscus::results {

enum class DatafileMethod { Newton, Gradient, ConjugateGradients };

struct DatafileOptions {
  /// 1:4 refinements; empty: as many as give 2,000 facets.
  std::optional<int> refinements;
  DatafileMethod method = DatafileMethod::Newton;
  int max_steps = 2000;  // of the two descents
  /// Run this macro of the file instead of our own route.
  std::optional<std::string> macro;
  /// Settle, pop junctions of too many films, and settle again, until none is
  /// left (Newton only).
  bool pop = false;
  std::map<std::string, double> parameters;
  Monitor* monitor = nullptr;
};

struct DatafileResult {
  films::FilmComplex complex;  // settled
  settle::FilmReport report;
  std::vector<std::pair<std::string, double>> quantities;
  std::optional<Failure> failure;
  films::NestingReport nesting;  // of a film that did not fail
  std::string printed;           // by the macro
  int popped = 0;                // junctions
  bool stopped = false;  // a descent, on request: the film as it was then
};

/// Reads `path` and settles its films by our own route. Throws InvalidInput
/// with file, line and column, IoError, Interrupted. A macro may end anywhere:
/// that is no failure, and the report says how far from rest the film is.
DatafileResult evolve_datafile(const std::filesystem::path& path,
                               const DatafileOptions& options);

/// Names of the surfaces that are no films.
std::vector<std::string> solids_of(const films::FilmComplex& complex);

/// film.vtp, film.fe and film.json in `folder`; `title`: one line for people.
/// Throws IoError. Returns a warning when the film cannot be said in a
/// datafile, else nothing.
std::string write_datafile_result(const DatafileResult& result,
                                  const std::string& title,
                                  const std::filesystem::path& folder);

/// The result for people; a datafile has no units.
std::string datafile_text(const DatafileResult& result);

}  // namespace meniscus::results
