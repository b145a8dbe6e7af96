/// What a run leaves in its folder beside result.json.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "pipeline/study/study.h"
#include "pipeline/study/study_monitor.h"
#include "report/picture/renderer.h"

namespace meniscus::output {

struct RunOutputOptions {
  bool pictures = true;
  bool frame_pictures = false;  // and one of each film of the history
  double picture_scale = 1.0;   // of their width and height
  /// Formats of export_formats() to write the part in besides.
  std::vector<std::string> exports = {};
  std::string program_version = {};  // for the heads of those files
  double time_limit = 0.0;     // [s], from the start of the run: no pictures
                               // beyond it; 0: none
  Monitor* monitor = nullptr;  // not owned
  /// That several runs share, not owned; null: one of its own.
  picture::Renderer* renderer = nullptr;
};

/// The files of one run, from its best design on.
class RunOutput {
 public:
  /// `input` must outlive it.
  RunOutput(const case_data::Case& input, std::filesystem::path folder,
            const RunOutputOptions& options);

  /// For StudyOptions::answered: the pictures are begun, beside what the study
  /// still has to compute.
  void begin(const forward::EvaluationFields& fields);

  /// Meshes of the best design, films of the history, exports, pictures and the
  /// ledger, or the surface that could not be filled; warnings go to `result`,
  /// also of an export that does not work out.
  /// Throws IoError, Interrupted.
  void finish(const forward::EvaluationFields& fields,
              study::RunResult& result);

 private:
  void write_meshes(const forward::EvaluationFields& fields,
                    study::RunResult& result);
  void show_failed_film(const forward::EvaluationFields& fields,
                        study::RunResult& result);
  std::vector<std::filesystem::path> export_all(study::RunResult& result);
  void finish_pictures(const forward::EvaluationFields& fields,
                       study::RunResult& result);
  void draw_pictures(const forward::EvaluationFields& fields,
                     study::RunResult& result);

  const case_data::Case& input_;
  std::filesystem::path folder_;
  RunOutputOptions options_;
  Monitor& monitor_;
  study::DeadlineMonitor in_time_;  // of pictures
  picture::Renderer own_renderer_;
  std::optional<picture::PicturesBeside> pictures_;
};

}  // namespace meniscus::output
