/// A case's study, or its family, run into a folder: the database, meshes,
/// pictures, result.json and the page. The command line and Python call this;
/// they differ in how they listen.
#pragma once

#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "pipeline/results/family.h"
#include "pipeline/store/study_store.h"
#include "pipeline/study/study.h"

namespace meniscus::output {

class RunOutput;

struct FolderRunOptions {
  std::filesystem::path folder;
  std::string program_version;  // for the files
  std::string page_versions;    // as in ReportOptions
  bool resume = false;          // go on with the study that is there
  int jobs = 1;                 // designs, or members of a family, side by side
  int threads = 1;              // of all members of a family together, >= 1
  double time_limit = 0.0;      // [s], 0: none
  bool estimate_errors = true;  // of a study that is no family
  bool pictures = true;         // where the helper program is found
  bool frames = true;           // films of the design's history
  bool frame_pictures = false;  // and a picture of each
  bool report = true;           // report.html
  std::vector<std::string> exports = {};   // formats to write the part in
  std::vector<std::string> warnings = {};  // of the case, for result.json
  /// What a run that ended early is to be gone on with, for its message.
  std::string resume_hint = "--resume";
  /// Members of a family get pictures also when its time is up.
  bool pictures_when_late = false;
};

/// How the caller listens; any may be empty. All but `evaluated` (on a member's
/// thread) are called on the thread that runs.
struct FolderRunListener {
  Monitor* monitor = nullptr;  // not owned
  study::StudyListener evaluated = {};
  /// result.json is written, the page is not yet.
  std::function<void(const study::RunResult&)> finished = {};
  /// The run was stopped or a file refused; result.json comes after this, and a
  /// full disk may refuse that too.
  std::function<void(const study::RunResult&)> ended_early = {};
  std::function<void(const std::string&)> page_warning = {};
  /// Who stopped the run, for its message; asked once it was.
  std::function<std::string()> stop_reason = {};
};

struct FolderRunResult {
  study::RunResult result;
  std::exception_ptr error;  // Interrupted or IoError that ended it early
};

/// Refuses what no run can compute and makes the folder. Throws InvalidInput,
/// IoError.
void prepare_run_folder(const case_data::Case& input,
                        const std::filesystem::path& folder);

/// A study that is no family.
class FolderRun {
 public:
  /// Prepares the folder and opens the study in it, locked for as long as this
  /// lives. `input` must outlive it. Throws as prepare_run_folder(),
  /// open_run().
  FolderRun(const case_data::Case& input, FolderRunOptions options);

  /// Once. An interruption or an IoError is kept in the folder's result.json
  /// and returned; anything else that ends the study passes through, as does
  /// the IoError of a disk that refuses result.json as well.
  FolderRunResult run(const FolderRunListener& listener);

 private:
  study::RunResult study(const FolderRunListener& listener, RunOutput& output);
  study::RunResult keep(const FolderRunListener& listener,
                        study::RunStatus status, const std::string& reason);

  const case_data::Case& input_;
  FolderRunOptions options_;
  store::StudyStore store_;
};

/// The family's members with their meshes and pictures, into a folder that is
/// prepared; no page. Throws what run_family() throws.
results::FamilyResult run_family_into_folder(const case_data::Case& input,
                                             const FolderRunOptions& options,
                                             const FolderRunListener& listener);

/// The pages of the members that have a result, then the family's own.
void write_family_pages(const results::FamilyResult& result,
                        const FolderRunOptions& options,
                        const FolderRunListener& listener);

}  // namespace meniscus::output
