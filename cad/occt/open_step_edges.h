/// Internal to the helper `meniscus-step`: the edges of a file that it holds
/// open.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cad/step/step_edges.h"

namespace meniscus::occt {

/// StepEdges in the process that calls, which OpenCASCADE may end on a damaged
/// file. One at a time: its settings are the process's own.
class OpenStepEdges {
 public:
  OpenStepEdges(const std::filesystem::path& path, const std::string& unit);
  OpenStepEdges(OpenStepEdges&&) noexcept;
  OpenStepEdges& operator=(OpenStepEdges&&) noexcept;
  ~OpenStepEdges();

  step::StepLoop loop(const std::vector<std::string>& edges) const;
  step::StepLoop rim(const std::string& face) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::occt
