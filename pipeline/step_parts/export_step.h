/// A finished run's part as STEP.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cad/step/mirror_brep.h"
#include "core/monitor.h"
#include "evolve/films/film_system.h"

namespace meniscus::step_parts {

struct StepExport {
  std::string title;        // of the part
  std::string unit = "mm";  // of lengths
  double edge = 0.0;        // the film is settled at this edge [length], > 0
  bool faceted = false;     // every facet a plane, for want of better
  std::vector<step::MirrorPlane> mirrors = {};  // of a part that is drawn
  Monitor* monitor = nullptr;  // hears what was measured, asked for a stop
};

/// What is drawn and its images in options.mirrors.
solid::Brep whole_solid(solid::Brep brep, const StepExport& options);

/// Settles the films of `system` and writes them as a closed solid: films as
/// B-spline faces, caps as planes with their exact rims. Throws MeshError (no
/// stable film, a film that cannot be cut into patches, no valid solid),
/// IoError, Interrupted.
void export_step(const std::filesystem::path& file,
                 const films::FilmSystem& system, const StepExport& options);

}  // namespace meniscus::step_parts
