#include "core/find_program.h"

#include <cstdlib>
#include <string_view>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"

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

/// Where helpers are looked for, in this order.
std::vector<fs::path> helper_folders() {
  std::vector<fs::path> folders = added_folders();
  std::error_code failed;
  const fs::path self = fs::read_symlink("/proc/self/exe", failed);
  if (!failed) {
    const fs::path here = self.parent_path();
    folders.push_back(here);
    folders.push_back(here.parent_path() / "libexec" / "meniscus");
  }
  folders.emplace_back(MENISCUS_HELPER_FOLDER);
  return folders;
}

/// What an environment variable says; empty as if it were not set.
std::string setting(const std::string& variable) {
  const char* set = std::getenv(variable.c_str());
  return set != nullptr ? set : "";
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
  if (const std::string set = setting(variable); !set.empty()) {
    return is_executable_file(set) ? std::optional<fs::path>(set)
                                   : std::nullopt;
  }
  for (const fs::path& folder : helper_folders()) {
    if (is_executable_file(folder / name)) {
      return folder / name;
    }
  }
  return std::nullopt;
}

std::string require_helper(const std::string& name, const std::string& variable,
                           const std::string& advice) {
  if (const auto found = find_helper(name, variable)) {
    return found->string();
  }
  if (const std::string set = setting(variable); !set.empty()) {
    throw IoError(fmt::format(
        "helper {} not found: the environment variable {} says '{}', which is "
        "not an executable file; correct or unset it",
        name, variable, set));
  }
  std::vector<std::string> looked;
  for (const fs::path& folder : helper_folders()) {
    looked.push_back((folder / name).string());
  }
  throw IoError(fmt::format("helper {} not found; looked for {}; {}", name,
                            fmt::join(looked, ", "), advice));
}

void add_helper_folder(const std::string& folder) {
  added_folders().emplace_back(folder);
}

}  // namespace meniscus
