/// A family: one case, a table of members, each sized by a study of its own.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/results/family_table.h"
#include "pipeline/study/study.h"

namespace meniscus::results {

struct FamilyOptions {
  std::filesystem::path folder;  // exists; locked for as long as it runs
  std::string program_version;
  /// Members that are finished are read, begun ones go on.
  bool resume = false;
  int jobs = 1;             // members side by side, >= 1; same bits for any
  int threads = 1;          // of all jobs together, >= 1
  double time_limit = 0.0;  // of the whole family [s], 0: none
  int frames = 0;           // as in StudyOptions, of each member
  study::StudyListener listener =
      {};  // as in StudyOptions; on a member's thread
  Monitor* monitor = nullptr;
  /// Writes a member's meshes and pictures into its folder, adds to its
  /// warnings; called on the member's thread. Empty: nothing is written.
  std::function<void(
      const case_data::Case& member, const forward::EvaluationFields& fields,
      const std::filesystem::path& folder, study::RunResult& result)>
      write_files = {};
};

/// Each member in FOLDER/members/NAME, as a run of its own would leave it
/// (result.json has one more key, `member`), and after each of them
/// FOLDER/family.csv; FOLDER/result.json comes last.
///
/// A member's model is frozen at its own initial design. Its optimizer starts
/// from the answer, clipped to its bounds, of its parent in family_tree(),
/// which is fixed before the first begins; from its own initial design where
/// the parent found none. So neither order nor `jobs` have a say.
///
/// What goes wrong with one member is its row; the others go on. Throws
/// IoError where a file or database cannot be written, InvalidInput where
/// another run has the folder. Interrupted does not pass: it is the status.
FamilyResult run_family(const case_data::Case& family,
                        const FamilyOptions& options);

}  // namespace meniscus::results
