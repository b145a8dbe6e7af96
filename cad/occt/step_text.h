/// Internal to the helper `meniscus-step`: solids as the text of a STEP file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cad/step/step_writer.h"

namespace meniscus::occt {

struct StepText {
  std::string text;
  step::StepReport report;
};

/// What write_step() writes to `path`, which only messages name. Throws
/// MeshError, InvalidInput and IoError as it does. One call at a time:
/// OpenCASCADE's settings are the process's own.
StepText step_text(const std::filesystem::path& path,
                   const std::vector<step::StepPart>& parts,
                   const step::StepOptions& options);

}  // namespace meniscus::occt
