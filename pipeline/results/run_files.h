/// What a run wrote into its folder and may take away again: nothing of an
/// earlier answer stays beside a newer one, and nothing of the user's goes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meniscus::results {

/// The list itself, a name a line.
inline constexpr const char* kRunFilesName = "run_files.txt";

/// Puts names of files in `folder` on its list, before they are written: a run
/// that is killed owns them too. Throws IoError.
void claim_files(const std::filesystem::path& folder,
                 const std::vector<std::string>& names);

/// Names on the list, in its order; none without one. Only plain names of files
/// in the folder count, whatever the list says.
std::vector<std::string> owned_files(const std::filesystem::path& folder);

/// Removes what the list names, and the list. `was_run`: the folder held a run
/// before; one of a version that kept no list owned the usual names. Throws
/// IoError where a file cannot be removed.
void remove_owned_files(const std::filesystem::path& folder, bool was_run);

}  // namespace meniscus::results
