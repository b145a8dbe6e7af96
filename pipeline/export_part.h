/// A finished run's part, written for another program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/monitor.h"

namespace meniscus {

struct ExportOptions {
  std::string format = "stl";   // "stl", "step", "step-faceted", "inp", "vtu"
  std::optional<double> edge;   // [length]; the run's own when absent
  std::filesystem::path out;    // file; empty: part_<edge>.<format> in the run
  std::string program_version;  // for the deck's head
  Monitor* monitor = nullptr;
};

/// Settles and meshes the best design of the study in `folder` again, which is
/// the same bits when no edge is given, and writes it. Returns the file.
/// Throws IoError (no study there, file), InvalidInput (unknown format, no
/// finished evaluation), MeshError (no film or mesh at that edge).
std::filesystem::path export_part(const std::filesystem::path& folder,
                                  const ExportOptions& options);

}  // namespace meniscus
