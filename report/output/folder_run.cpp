#include "report/output/folder_run.h"

#include <algorithm>
#include <mutex>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/count_text.h"
#include "core/error.h"
#include "core/timer.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/walls.h"
#include "pipeline/forward/work_estimate.h"
#include "pipeline/frames/film_frames.h"
#include "pipeline/results/results.h"
#include "pipeline/results/run_folder.h"
#include "pipeline/study/time_limit.h"
#include "report/output/run_output.h"
#include "report/page/report_page.h"

namespace meniscus::output {

namespace fs = std::filesystem;

namespace {

// Of a run's: pages show many members beside one another, and pixels are most
// of what pictures cost.
constexpr double kMemberPictures = 0.6;

store::StudyStore open_prepared(const case_data::Case& input,
                                const FolderRunOptions& options) {
  prepare_run_folder(input, options.folder);
  return results::open_run(
      input, options.folder,
      options.resume ? results::RunBegins::Resumed : results::RunBegins::Anew,
      options.program_version);
}

/// Of a study; a family's members have no time limit of their own.
RunOutputOptions output_options(const FolderRunOptions& options,
                                const FolderRunListener& listener) {
  return {.pictures = options.pictures,
          .frame_pictures = options.frame_pictures,
          .exports = options.exports,
          .program_version = options.program_version,
          .time_limit = options.time_limit,
          .monitor = listener.monitor};
}

void write_run_page(const fs::path& folder, const FolderRunOptions& options,
                    const FolderRunListener& listener) {
  if (options.report) {
    page::write_report_or_warn(folder, {.versions = options.page_versions},
                               listener.monitor, listener.page_warning);
  }
}

}  // namespace

void prepare_run_folder(const case_data::Case& input, const fs::path& folder) {
  forward::refuse_walls(input);
  forward::require_solver(input);
  forward::require_work(input);
  make_folder(folder);
}

FolderRun::FolderRun(const case_data::Case& input, FolderRunOptions options)
    : input_(input),
      options_(std::move(options)),
      store_(open_prepared(input, options_)) {}

/// Meshes and pictures first, result.json last: it tells that all is there.
study::RunResult FolderRun::study(const FolderRunListener& listener,
                                  RunOutput& output) {
  forward::EvaluationFields fields;
  study::RunResult result =
      study::run_study(input_, store_,
                       {.time_limit = options_.time_limit,
                        .estimate_errors = options_.estimate_errors,
                        .frames = options_.frames ? frames::kMostFrames : 0,
                        .jobs = options_.jobs,
                        .listener = listener.evaluated,
                        .answered =
                            [&](const forward::EvaluationFields& answer) {
                              output.begin(answer);
                            },
                        .monitor = listener.monitor},
                       &fields);
  result.warnings.insert(result.warnings.begin(), options_.warnings.begin(),
                         options_.warnings.end());
  const Timer timer;
  output.finish(fields, result);
  result.output_seconds = timer.seconds();
  result.total_seconds += result.output_seconds;
  results::write_summary(input_, result, store_.all(), options_.program_version,
                         options_.folder);
  if (listener.finished) {
    listener.finished(result);
  }
  write_run_page(options_.folder, options_, listener);
  return result;
}

/// The state of a run that ended early, for people and for a resumed one.
study::RunResult FolderRun::keep(const FolderRunListener& listener,
                                 study::RunStatus status,
                                 const std::string& reason) {
  study::RunResult result = results::partial_result(
      input_, store_, status, reason, options_.resume_hint);
  if (listener.ended_early) {
    listener.ended_early(result);
  }
  results::write_summary(input_, result, store_.all(), options_.program_version,
                         options_.folder);
  write_run_page(options_.folder, options_, listener);
  return result;
}

FolderRunResult FolderRun::run(const FolderRunListener& listener) {
  RunOutput output(input_, options_.folder, output_options(options_, listener));
  try {
    return {study(listener, output), nullptr};
  } catch (const study::TimeIsUp& late) {
    return {keep(listener, study::RunStatus::Stopped, late.what()),
            std::current_exception()};
  } catch (const Interrupted&) {
    const std::string reason =
        listener.stop_reason ? listener.stop_reason() : "stopped on request";
    return {keep(listener, study::RunStatus::Interrupted, reason),
            std::current_exception()};
  } catch (const IoError& error) {
    // A full disk may well refuse result.json too; the study is safe.
    return {keep(listener, study::RunStatus::Error, error.what()),
            std::current_exception()};
  }
}

results::FamilyResult run_family_into_folder(
    const case_data::Case& input, const FolderRunOptions& options,
    const FolderRunListener& listener) {
  std::mutex writing;  // one CAD kernel at a time
  picture::Renderer renderer;
  std::size_t without_pictures = 0;  // members
  std::string why;
  const Timer timer;
  const auto write_member = [&](const case_data::Case& member,
                                const forward::EvaluationFields& fields,
                                const fs::path& folder,
                                study::RunResult& outcome) {
    const std::lock_guard<std::mutex> guard(writing);
    RunOutputOptions chosen = output_options(options, listener);
    chosen.renderer = &renderer;
    chosen.picture_scale = kMemberPictures;
    chosen.time_limit = 0.0;  // of all members, not of each
    if (chosen.pictures && !options.pictures_when_late &&
        options.time_limit > 0.0 && timer.seconds() >= options.time_limit) {
      chosen.pictures = false;
      outcome.warnings.emplace_back(
          "the family's time limit left no time for pictures");
    }
    const std::size_t before = outcome.warnings.size();
    RunOutput(member, folder, chosen).finish(fields, outcome);
    const auto lost = std::find_if(
        outcome.warnings.begin() + static_cast<std::ptrdiff_t>(before),
        outcome.warnings.end(), picture::is_about_pictures);
    if (lost != outcome.warnings.end() && without_pictures++ == 0) {
      why = *lost;
    }
  };
  results::FamilyResult result = results::run_family(
      input, {.folder = options.folder,
              .program_version = options.program_version,
              .resume = options.resume,
              .jobs = options.jobs,
              .threads = options.threads,
              .time_limit = options.time_limit,
              .frames = options.frames ? frames::kMostFrames : 0,
              .listener = listener.evaluated,
              .monitor = listener.monitor,
              .write_files = write_member});
  if (without_pictures > 0) {
    result.warnings.push_back(
        fmt::format("{}: {}", count_text(without_pictures, "member"), why));
  }
  return result;
}

void write_family_pages(const results::FamilyResult& result,
                        const FolderRunOptions& options,
                        const FolderRunListener& listener) {
  for (const results::FamilyRow& row : result.rows) {
    const fs::path folder = options.folder / row.folder;
    if (fs::exists(folder / "result.json")) {
      write_run_page(folder, options, listener);
    }
  }
  write_run_page(options.folder, options, listener);
}

}  // namespace meniscus::output
