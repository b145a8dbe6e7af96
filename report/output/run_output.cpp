#include "report/output/run_output.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/timer.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/frames/film_frames.h"
#include "pipeline/results/export_part.h"
#include "pipeline/results/make_ledger.h"
#include "pipeline/results/results.h"
#include "pipeline/results/run_files.h"
#include "report/output/run_pictures.h"

namespace meniscus::output {

namespace fs = std::filesystem;

RunOutput::RunOutput(const case_data::Case& input, fs::path folder,
                     const RunOutputOptions& options)
    : input_(input),
      folder_(std::move(folder)),
      options_(options),
      monitor_(options.monitor != nullptr ? *options.monitor
                                          : silent_monitor()),
      in_time_(monitor_, options.time_limit) {}

void RunOutput::begin(const forward::EvaluationFields& fields) {
  if (options_.pictures && !fields.mesh.nodes.empty()) {
    std::vector<picture::PictureJob> jobs =
        run_pictures(input_, fields, folder_);
    std::vector<std::string> names;
    names.reserve(jobs.size());
    for (picture::PictureJob& job : jobs) {
      names.push_back(fs::path(job.output).filename().string());
      for (int* side : {&job.width, &job.height}) {
        *side = static_cast<int>(std::lround(options_.picture_scale * *side));
      }
    }
    results::claim_files(folder_, names);
    pictures_.emplace(
        options_.renderer != nullptr ? *options_.renderer : own_renderer_,
        std::move(jobs), &in_time_);
  }
}

void RunOutput::finish(const forward::EvaluationFields& fields,
                       study::RunResult& result) {
  const Timer timer;
  std::vector<fs::path> exported;
  if (!fields.mesh.nodes.empty()) {
    monitor_.progress({.stage = "output", .detail = "writing meshes"});
    write_meshes(fields, result);
    frames::write_frames(input_, fields.history, folder_);
    exported = export_all(result);
    if (options_.pictures) {
      finish_pictures(fields, result);
    }
  }
  if (fields.mesh.nodes.empty() && !fields.film.facets.empty()) {
    show_failed_film(fields, result);
  }
  if (result.best && !fields.mesh.nodes.empty()) {
    result.output_seconds = timer.seconds();
    result.ledger =
        results::make_ledger(input_, result, fields, folder_, exported);
  }
  for (const std::string& name : results::write_unfilled(fields, folder_)) {
    result.warnings.push_back("look at the surface in " + name);
  }
}

void RunOutput::write_meshes(const forward::EvaluationFields& fields,
                             study::RunResult& result) {
  try {
    for (std::string& warning :
         results::write_meshes(input_, fields, folder_, in_time_)) {
      result.warnings.push_back(std::move(warning));
    }
  } catch (const Interrupted&) {
    if (monitor_.stop_requested()) {
      throw;
    }
    result.warnings.push_back(fmt::format(
        "the time limit of {:g} s left no time for all STL files of "
        "resolution.export",
        options_.time_limit));
  }
}

/// A film that does not stand, to be looked at.
void RunOutput::show_failed_film(const forward::EvaluationFields& fields,
                                 study::RunResult& result) {
  results::claim_files(folder_, {"film.vtp", "film.png"});
  results::write_film(input_, fields.film, folder_);
  if (!options_.pictures) {
    result.warnings.emplace_back("look at the film in film.vtp");
    return;
  }
  for (std::string& warning :
       draw_film(input_.title, case_data::solids_of_whole(input_), {}, folder_,
                 monitor_)) {
    result.warnings.push_back(std::move(warning));
  }
  result.warnings.emplace_back("look at the film in film.png");
}

/// The answer in the formats asked for, as `meniscus export` writes it.
std::vector<fs::path> RunOutput::export_all(study::RunResult& result) {
  std::vector<fs::path> files;
  for (const std::string& format : options_.exports) {
    monitor_.progress({.stage = "output", .detail = "writing " + format});
    try {
      files.push_back(results::export_part(
          folder_, {.format = format,
                    .program_version = options_.program_version,
                    .monitor = options_.monitor}));
    } catch (const Interrupted&) {
      throw;
    } catch (const IoError&) {
      throw;
    } catch (const Error& error) {
      result.warnings.push_back(
          fmt::format("{}{}: {}", results::kNotWritten, format, error.what()));
    }
  }
  return files;
}

/// What was begun, and what needs the frames.
void RunOutput::finish_pictures(const forward::EvaluationFields& fields,
                                study::RunResult& result) {
  try {
    throw_if_stopped(in_time_, "output");
    draw_pictures(fields, result);
  } catch (const Interrupted&) {
    if (monitor_.stop_requested()) {
      throw;
    }
    pictures_.reset();
    result.warnings.push_back(
        fmt::format("the time limit of {:g} s left no time for pictures",
                    options_.time_limit));
  }
}

void RunOutput::draw_pictures(const forward::EvaluationFields& fields,
                              study::RunResult& result) {
  monitor_.progress({.stage = "output", .detail = "drawing pictures"});
  const auto warn = [&](std::vector<std::string> warnings) {
    result.warnings.insert(result.warnings.end(), warnings.begin(),
                           warnings.end());
  };
  if (!pictures_) {
    begin(fields);
  }
  warn(pictures_->wait());
  pictures_.reset();
  if (!options_.frame_pictures || fields.history.empty()) {
    return;
  }
  std::vector<std::string> captions;
  captions.reserve(fields.history.size());
  for (const forward::FilmFrame& frame : fields.history) {
    captions.push_back(frames::frame_caption(input_, frame));
  }
  std::vector<std::string> solids;
  for (const films::CapSpec& cap : fields.inputs.film_system.caps) {
    solids.push_back(cap.name);
  }
  warn(draw_frames(input_.title, solids, fields.history, captions, folder_,
                   in_time_));
}

}  // namespace meniscus::output
