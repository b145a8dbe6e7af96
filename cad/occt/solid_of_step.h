/// Internal to the helper `meniscus-step`: the solid of a file as it is.
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/exact_shape.h"

namespace meniscus::occt {

/// read_step_solid() in the process that calls, which OpenCASCADE may end on a
/// damaged file. One call at a time: its settings are the process's own.
ExactShape solid_of_step(const std::filesystem::path& path,
                         const std::string& unit);

}  // namespace meniscus::occt
