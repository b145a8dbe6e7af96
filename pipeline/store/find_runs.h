/// Folders of runs.
#pragma once

#include <filesystem>
#include <vector>

namespace meniscus::store {

/// The folders to export for a results folder: itself, or those of a family's
/// members, by name. Throws IoError for a folder that is not there or has
/// neither a study nor members.
std::vector<std::filesystem::path> runs_in(const std::filesystem::path& folder);

}  // namespace meniscus::store
