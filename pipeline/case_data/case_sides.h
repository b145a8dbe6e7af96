/// Plane faces that meet along the sides of polygons.
#pragma once

#include <string>

#include "evolve/films/film_system.h"
#include "pipeline/case_data/case_values.h"

namespace meniscus::case_data {

/// Is the curve a polygon whose caps may be closed by other faces, side by
/// side? So it is where it and two more polygons have caps, as faces of a
/// wedge do.
bool may_join_by_sides(const Case& input, const std::string& curve);

/// Tells of bodies whose faces leave a polygon's side open, or meet there more
/// than two at a time.
void check_sides(const Case& input, const films::FilmSystem& system,
                 const CaseValues& values);

}  // namespace meniscus::case_data
