/// The walls of a case on its settled film.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "evolve/frozen/film_model.h"
#include "evolve/walls/wall_model.h"
#include "pipeline/case_data/case.h"

namespace meniscus::forward {

struct CaseWall {
  std::string name;
  walls::ThickWall wall;
  std::vector<double> safe;  // largest safe thickness [length], per point;
                             // empty where nobody asked
};

/// The walls of a case that has some, on the film `points` of a state of
/// `model`. Throws InvalidInput and MeshError as WallModel.
walls::WallModel wall_model(const case_data::EvaluatedCase& inputs,
                            const frozen::FilmModel& model,
                            const Points& points);

/// Those of a model, one for each set of walls that meet, named after its
/// first.
std::vector<CaseWall> named_walls(const case_data::EvaluatedCase& inputs,
                                  const walls::WallModel& model);

/// Both in one; none for a case without walls.
std::vector<CaseWall> make_walls(const case_data::EvaluatedCase& inputs,
                                 const frozen::FilmModel& model,
                                 const Points& points);

/// The closed surface of the part on the film `points` of a state of `model`:
/// walls or fillets made anew there, or what bounds its bodies.
SurfaceMesh boundary_of(const case_data::EvaluatedCase& inputs,
                        const frozen::FilmModel& model, const Points& points);

/// Why the walls cannot be meshed, with place and largest safe thickness.
std::optional<Failure> wall_failure(const case_data::EvaluatedCase& inputs,
                                    const walls::WallModel& model);

/// The wall for people: thickness, volume, the largest safe thickness.
std::string wall_text(const case_data::Case& input, const CaseWall& wall);

/// wall_NAME.vtp, wall_NAME.stl and wall_NAME.json in `folder`. Throws IoError.
void write_wall(const case_data::Case& input, const CaseWall& wall,
                const std::filesystem::path& folder);

/// Throws InvalidInput, with line and advice, for walls that cannot be
/// analysed: beside solid bodies, or without material, loads or responses.
void refuse_walls(const case_data::Case& input);

}  // namespace meniscus::forward
