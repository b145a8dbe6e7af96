/// Internal to the helper `meniscus-step`: what is read from STEP in the
/// process that calls. OpenCASCADE may end it on a damaged file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cad/step/step_edges.h"
#include "cad/step/step_reader.h"
#include "core/geometry/exact_shape.h"

namespace meniscus::step {

/// read_step_part(). One call at a time: OpenCASCADE's settings are the
/// process's own.
SurfaceMesh tessellate_step(const std::filesystem::path& path,
                            const ReadStepOptions& options);

/// read_step_solid(). One at a time.
ExactShape solid_of_step(const std::filesystem::path& path,
                         const std::string& unit);

/// StepEdges. One at a time.
class OpenStepEdges {
 public:
  OpenStepEdges(const std::filesystem::path& path, const std::string& unit);
  OpenStepEdges(OpenStepEdges&&) noexcept;
  OpenStepEdges& operator=(OpenStepEdges&&) noexcept;
  ~OpenStepEdges();

  StepLoop loop(const std::vector<std::string>& edges) const;
  StepLoop rim(const std::string& face) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::step
