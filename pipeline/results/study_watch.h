/// A results folder as seen from outside, while a run is at work in it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/study/progress_tracker.h"

namespace meniscus::results {

/// What a folder shows at one moment.
struct StudyStatus {
  bool at_work = false;  // a run holds the folder
  std::string holder;    // then who: "process 12 on host"
  bool family = false;   // a family's table
  std::string status;    // of result.json; empty: there is none
  std::string message;   // likewise
  std::string title;     // of the case; empty: not known yet
  int evaluations = 0;   // in the database
  std::vector<std::string>
      new_lines;     // a line for each that is beyond `known`, or
                     // for each member whose row has changed
  std::string text;  // all of it, some lines, for a terminal
};

/// Looks at one folder again and again.
class StudyWatch {
 public:
  /// Throws IoError, with what to give instead, for a folder that holds neither
  /// a study nor a family and where no run is at work.
  explicit StudyWatch(std::filesystem::path folder);

  /// What has come since the last call is in `new_lines`. A database that
  /// cannot be read just now shows as nothing new while a run is at work; else
  /// throws what StudyStore::read does.
  StudyStatus poll();

 private:
  void poll_study(StudyStatus& status);
  void poll_family(StudyStatus& status);
  void poll_result(StudyStatus& status) const;

  std::filesystem::path folder_;
  int last_seen_ = 0;              // evaluations
  std::vector<std::string> rows_;  // of the family, as last seen
};

}  // namespace meniscus::results
