#include "core/find_program.h"

#include <cstdlib>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace meniscus {

namespace fs = std::filesystem;

namespace {

bool is_executable_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) &&
         ::access(path.c_str(), X_OK) == 0;
}

std::vector<fs::path>& added_folders() {
  static std::vector<fs::path> folders;
  return folders;
}

}  // namespace

std::optional<fs::path> find_program(const std::string& name) {
  if (name.find('/') != std::string::npos) {
    return is_executable_file(name) ? std::optional<fs::path>(name)
                                    : std::nullopt;
  }
  const char* variable = std::getenv("PATH");
  std::string_view rest = variable != nullptr ? variable : "/usr/bin:/bin";
  while (!name.empty()) {
    const auto end = rest.find(':');
    const std::string_view folder = rest.substr(0, end);
    const fs::path path = fs::path(folder.empty() ? "." : folder) / name;
    if (is_executable_file(path)) {
      return path;
    }
    if (end == std::string_view::npos) {
      break;
    }
    rest.remove_prefix(end + 1);
  }
  return std::nullopt;
}

std::optional<fs::path> find_helper(const std::string& name,
                                    const std::string& variable) {
  if (const char* set = std::getenv(variable.c_str());
      set != nullptr && *set != '\0') {
    return is_executable_file(set) ? std::optional<fs::path>(set)
                                   : std::nullopt;
  }
  std::error_code failed;
  const fs::path self = fs::read_symlink("/proc/self/exe", failed);
  if (failed) {
    return std::nullopt;
  }
  const fs::path here = self.parent_path();
  std::vector<fs::path> folders = added_folders();
  folders.push_back(here);
  folders.push_back(here.parent_path() / "libexec" / "meniscus");
  for (const fs::path& folder : folders) {
    if (is_executable_file(folder / name)) {
      return folder / name;
    }
  }
  return std::nullopt;
}

void add_helper_folder(const std::string& folder) {
  added_folders().emplace_back(folder);
}

}  // namespace meniscus
