/// Faces that meet along the sides of polygons and polylines.
#pragma once

#include <string>

#include "evolve/films/film_system.h"
#include "pipeline/case_data/case_values.h"

namespace meniscus::case_data {

/// Is the curve one of sides, at which other faces may close what ends there,
/// side by side? So it is where two more such curves have caps, as faces of a
/// wedge do.
bool may_join_by_sides(const Case& input, const std::string& curve);

/// Case::sharing_sides, of curves that were read without a problem; none where
/// their numbers are not good.
CurvePairs curves_that_share_sides(const Case& input);

/// Tells of free sides of polygons and polylines where fewer than three films
/// meet, or a solid's face.
void check_free_sides(const Case& input, const films::FilmSystem& system,
                      const CaseValues& values);

/// Tells of films that join others along a line that ends where nothing holds
/// these, or elsewhere along their curve than at the initial design: models
/// keep its place there. `first`: the curves of that design.
void check_join_ends(const Case& input, const films::FilmSystem& system,
                     const std::vector<curves::Curve>& first,
                     std::vector<std::string>& problems);

/// Tells of bodies whose faces leave a curve's side open, or meet there more
/// than two at a time.
void check_sides(const Case& input, const films::FilmSystem& system,
                 const CaseValues& values);

}  // namespace meniscus::case_data
