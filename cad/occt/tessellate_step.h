/// Internal to the helper `meniscus-step`: the faces of a file as facets.
#pragma once

#include <filesystem>

#include "cad/step/step_reader.h"
#include "core/geometry/surface_mesh.h"

namespace meniscus::occt {

/// read_step_part() in the process that calls, which OpenCASCADE may end on a
/// damaged file. One call at a time: its settings are the process's own.
SurfaceMesh tessellate_step(const std::filesystem::path& path,
                            const step::ReadStepOptions& options);

}  // namespace meniscus::occt
