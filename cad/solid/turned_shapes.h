/// Internal to simple_film: what surfaces of revolution have in common.
#pragma once

#include <optional>
#include <vector>

#include "cad/solid/simple_film.h"

namespace meniscus::solid {

inline constexpr double kExactRim = 1e-7;  // of rims, of the film's size

struct RimCircle {
  Vec3 center;
  Vec3 normal;  // unit
  Vec3 zero;    // unit, to the curve's own beginning
  double radius = 0.0;
};

/// The rims as circles; nothing where one is no whole circle.
std::optional<std::vector<RimCircle>> circles_of(
    const std::vector<FilmRim>& rims);

/// Both on one axis; `size`: the film's [length].
bool coaxial(const RimCircle& a, const RimCircle& b, double size);

/// The film's bounding diagonal [length].
double size_of(const FilmMesh& mesh);

/// How far a chord of length `edge` leaves a circle of this radius.
double sagitta(double edge, double radius);

/// True where facets look towards `center` or the axis through it.
bool looks_inward(const FilmMesh& mesh, const Vec3& center, const Vec3& axis);

// Each as simple_film(); `limit` [length].

/// Between two equal circles.
std::optional<SimpleFilm> cylinder_of(const FilmMesh& mesh,
                                      const std::vector<RimCircle>& rims,
                                      double limit, double edge);
/// Between two equal arcs on one axis and two lines along it.
std::optional<SimpleFilm> part_cylinder_of(const FilmMesh& mesh,
                                           const std::vector<FilmRim>& rims,
                                           double limit, double edge);
std::optional<SimpleFilm> cone_of(const FilmMesh& mesh,
                                  const std::vector<RimCircle>& rims,
                                  double limit);

}  // namespace meniscus::solid
