#include "pipeline/store/find_runs.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::store {

namespace {

namespace fs = std::filesystem;

}  // namespace

std::vector<fs::path> runs_in(const fs::path& folder) {
  std::error_code error;
  const fs::path members = folder / "members";
  if (fs::exists(folder / "study.sqlite", error) ||
      !fs::is_directory(members, error)) {
    return {folder};  // where the study is missing, reading it tells
  }
  std::vector<fs::path> runs;
  for (fs::directory_iterator entry(members, error), end;
       !error && entry != end; entry.increment(error)) {
    if (fs::exists(entry->path() / "study.sqlite", error)) {
      runs.push_back(entry->path());
    }
  }
  if (error || runs.empty()) {
    throw IoError(fmt::format(
        "no member of the family in '{}' has a study{}; run the family",
        folder.string(), error ? " (" + error.message() + ")" : ""));
  }
  std::sort(runs.begin(), runs.end());
  return runs;
}

}  // namespace meniscus::store
