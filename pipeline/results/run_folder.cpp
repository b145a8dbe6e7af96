#include "pipeline/results/run_folder.h"

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "pipeline/results/results.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/film_frames.h"
#include "pipeline/study/result_so_far.h"
#include "pipeline/study/study_records.h"

namespace meniscus {

namespace fs = std::filesystem;

StudyStore open_run(const Case& input, const fs::path& folder, RunBegins begins,
                    const std::string& program_version) {
  const StudyMeta meta{.program_version = program_version,
                       .case_hash = input.hash,
                       .case_text = stored_case(input)};
  StudyStore store = begins == RunBegins::Resumed
                         ? StudyStore::resume(folder.string(), meta)
                         : StudyStore::start(folder.string(), meta);
  remove_leftovers(folder);
  try {
    for (const char* name : {"result.json", "family.csv", "report.html"}) {
      fs::remove(folder / name);
    }
    remove_frames(folder);
  } catch (const fs::filesystem_error& error) {
    throw IoError(error.what());
  }
  return store;
}

RunResult kept_result(const Case& input, const StudyStore& store,
                      RunStatus status, const std::string& reason,
                      const std::string& go_on) {
  RunResult result = result_so_far(input, store.all());
  result.status = status;
  result.message =
      fmt::format("{}; {} finished evaluation{} kept, go on with {}", reason,
                  store.size(), store.size() == 1 ? " is" : "s are", go_on);
  return result;
}

}  // namespace meniscus
