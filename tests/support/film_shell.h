/// Shells to be analysed: one film of a settled model, made solid by thickness.
#pragma once

#include <functional>
#include <string>

#include "core/geometry/surface_mesh.h"
#include "core/geometry/tet_mesh.h"

namespace meniscus::test_films {

struct ShellSpec {
  std::string film;        // label of the surface
  double thickness = 0.0;  // half of it on either side [length]
  /// Name of the rim that a place belongs to.
  std::function<std::string(const Vec3&)> rim;
};

/// Ten-node tetrahedra between the two offsets of a film, curved as the film
/// is: corners and mid-sides are vertices of the refined film, moved by
/// thicken() (evolve/walls/thicken.h). Labels: "front", to which the film's
/// normals point, "back", and those of the rims. Throws what thicken() throws,
/// and MeshError where the wall cannot be filled.
TetMesh film_shell(const QuadraticSurface& surface, const ShellSpec& spec);

}  // namespace meniscus::test_films
