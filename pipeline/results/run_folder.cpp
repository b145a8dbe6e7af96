#include "pipeline/results/run_folder.h"

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "pipeline/frames/film_frames.h"
#include "pipeline/results/results.h"
#include "pipeline/results/run_files.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/partial_result.h"
#include "pipeline/study/study_records.h"

namespace meniscus::results {

namespace fs = std::filesystem;

store::StudyStore open_run(const case_data::Case& input, const fs::path& folder,
                           RunBegins begins,
                           const std::string& program_version) {
  const store::StudyMeta meta{.program_version = program_version,
                              .case_hash = input.hash,
                              .case_text = store::stored_case(input)};
  const bool was_run = fs::exists(folder / "study.sqlite");
  store::StudyStore store =
      begins == RunBegins::Resumed
          ? store::StudyStore::resume(folder.string(), meta)
          : store::StudyStore::start(folder.string(), meta);
  remove_leftovers(folder);
  remove_owned_files(folder, was_run);
  try {
    for (const char* name : {"result.json", "family.csv", "report.html"}) {
      fs::remove(folder / name);
    }
    frames::remove_frames(folder);
  } catch (const fs::filesystem_error& error) {
    throw IoError(error.what());
  }
  claim_files(folder, {"history.csv"});
  return store;
}

study::RunResult partial_result(const case_data::Case& input,
                                const store::StudyStore& store,
                                study::RunStatus status,
                                const std::string& reason,
                                const std::string& go_on) {
  study::RunResult result = study::result_so_far(input, store.all());
  result.status = status;
  result.message =
      fmt::format("{}; {} finished evaluation{} kept, go on with {}", reason,
                  store.size(), store.size() == 1 ? " is" : "s are", go_on);
  return result;
}

}  // namespace meniscus::results
