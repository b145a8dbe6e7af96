/// Films that are planes, cylinders, cones or spheres: such a film is that
/// surface between its rims' exact circles, and needs no patches.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cad/solid/brep.h"
#include "cad/solid/cut_film.h"

namespace meniscus::solid {

/// A closed film has no rim, then the sphere's poles are its ends.
struct SimpleFilm {
  std::variant<PlaneSurface, CylinderSurface, ConeSurface, SphereSurface>
      surface;
  // Second parameter at the first and the second rim, the lower one first.
  double low = 0.0;
  double high = 0.0;
  int low_rim = -1;  // of the film's; -1: a pole. Not of planes
  int high_rim = -1;
  /// Of a cylinder: not all around, but within its one rim of two arcs and two
  /// lines, and nowhere at first parameter 0.
  bool is_part = false;
  double off = 0.0;  // farthest vertex of the film from it [length]
};

/// What the film is if no vertex lies farther off than its own discretisation
/// can tell: `limit_in_edges` of its `edge` [length], or what a chord of that
/// length leaves the surface. Planes: of any rims that lie in
/// one. Cylinders: between two equal circles opposite to each other, or two
/// equal arcs. Cones: between two circles on one axis. Spheres:
/// between one circle and its pole, between two circles on one axis, or whole.
std::optional<SimpleFilm> simple_film(const FilmMesh& mesh,
                                      const std::vector<FilmRim>& rims,
                                      double edge,
                                      double limit_in_edges = 1e-3);

/// "plane", "cylinder of radius 12", "cone of 45 degrees", "sphere of radius
/// 30".
std::string name_of(const SimpleFilm& film);

}  // namespace meniscus::solid
