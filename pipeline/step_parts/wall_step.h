/// Walls as STEP.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cad/solid/film_solid.h"
#include "core/geometry/surface_mesh.h"
#include "evolve/walls/thicken.h"
#include "pipeline/step_parts/export_step.h"

namespace meniscus::step_parts {

/// Walls that meet, closed and outward, with faces by their labels.
struct WallBody {
  std::string name;
  SurfaceMesh surface;
};

/// After the name of a face, of the line's end beside it.
inline constexpr const char* kLineEnd = "/end";

/// The wall's surface with the ends of the lines where films meet as labels of
/// their own, "F/rim:NAME/end".
SurfaceMesh with_ends(const walls::ThickWall& wall);

/// Sides, strips across the thickness, cut where they turn a corner, and ends
/// as faces. `edge`: of the film [length]. Throws as film_solid().
solid::FilmSolid wall_solid(const SurfaceMesh& surface, double edge);

/// Writes each as a closed solid; options.faceted: of plane facets. Throws as
/// export_step().
void export_walls(const std::filesystem::path& file,
                  const std::vector<WallBody>& walls,
                  const StepExport& options);

}  // namespace meniscus::step_parts
