/// The walls of a case on its settled film.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "evolve/film_model.h"
#include "pipeline/case.h"

namespace meniscus {

struct CaseWall {
  std::string name;
  ThickWall wall;
};

/// One per wall of the case, at the film's own resolution; rims are named
/// after the curves. Inside is the side that faces the middle of the film's
/// rim; of a flat film the side against its curve's normal. Throws
/// InvalidInput for films that meet three at a line and a thickness that is not
/// above 0 everywhere.
std::vector<CaseWall> make_walls(const EvaluatedCase& numbers,
                                 const FilmModel& model, const Points& points);

/// The wall for people: thickness, volume, the largest safe thickness.
std::string wall_text(const Case& input, const CaseWall& wall);

/// wall_NAME.vtp and wall_NAME.stl in `folder`. Throws IoError.
void write_wall(const Case& input, const CaseWall& wall,
                const std::filesystem::path& folder);

/// Throws InvalidInput, with line and advice, for a case whose walls would
/// have to be analysed: there are no elements of walls in this version.
void refuse_walls(const Case& input);

}  // namespace meniscus
