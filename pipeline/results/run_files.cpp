#include "pipeline/results/run_files.h"

#include <algorithm>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"

namespace meniscus::results {

namespace fs = std::filesystem;

namespace {

constexpr const char* kHead =
    "# written by meniscus, replaced by the next run in this folder:";

// Beside these, versions without a list wrote STL files under names that a
// user may have chosen too.
const std::vector<std::string>& usual_names() {
  static const std::vector<std::string> names = {
      "film.vtp",     "part.vtu",    "part_surface.vtp",
      "findings.vtp", "part.png",    "unfilled_surface.vtp",
      "film.png",     "overview.png"};
  return names;
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && name != "." && name != ".." &&
         name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos && name != kRunFilesName;
}

}  // namespace

std::vector<std::string> owned_files(const fs::path& folder) {
  std::vector<std::string> names;
  if (!fs::is_regular_file(fs::symlink_status(folder / kRunFilesName))) {
    return names;
  }
  std::istringstream list(read_file(folder / kRunFilesName));
  for (std::string line; std::getline(list, line);) {
    if (!line.starts_with('#') && is_plain_name(line)) {
      names.push_back(line);
    }
  }
  return names;
}

void claim_files(const fs::path& folder,
                 const std::vector<std::string>& names) {
  std::vector<std::string> all = owned_files(folder);
  const std::size_t before = all.size();
  for (const std::string& name : names) {
    if (is_plain_name(name) &&
        std::find(all.begin(), all.end(), name) == all.end()) {
      all.push_back(name);
    }
  }
  if (all.size() == before) {
    return;
  }
  std::string text = std::string(kHead) + "\n";
  for (const std::string& name : all) {
    text += name + "\n";
  }
  write_file(folder / kRunFilesName, text);
}

void remove_owned_files(const fs::path& folder, bool was_run) {
  const bool listed = fs::exists(folder / kRunFilesName);
  const std::vector<std::string> names =
      listed || !was_run ? owned_files(folder) : usual_names();
  try {
    for (const std::string& name : names) {
      // A link or folder of that name is not what a run wrote.
      if (fs::is_regular_file(fs::symlink_status(folder / name))) {
        fs::remove(folder / name);
      }
    }
    fs::remove(folder / kRunFilesName);
  } catch (const fs::filesystem_error& error) {
    throw IoError(error.what());
  }
}

}  // namespace meniscus::results
