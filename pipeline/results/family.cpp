#include "pipeline/results/family.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <omp.h>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/json.h"
#include "core/timer.h"
#include "optimize/samples/family_tree.h"
#include "pipeline/files/content_hash.h"
#include "pipeline/frames/film_frames.h"
#include "pipeline/reader/family_members.h"
#include "pipeline/results/export_part.h"
#include "pipeline/results/results.h"
#include "pipeline/results/run_files.h"
#include "pipeline/results/run_folder.h"
#include "pipeline/store/run_lock.h"
#include "pipeline/store/study_table.h"
#include "pipeline/study/held_margins.h"
#include "pipeline/study/partial_result.h"
#include "pipeline/study/study_records.h"
#include "pipeline/study/time_limit.h"

namespace meniscus::results {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// [s]; none at all would mean no limit.
constexpr double kLeastTime = 1e-3;

/// Says whose message it is; called from several threads.
class MemberMonitor : public Monitor {
 public:
  MemberMonitor(Monitor& family, std::string name)
      : family_(family), name_(std::move(name)) {}

  void log(Severity severity, const std::string& message) override {
    family_.log(severity, name_ + ": " + message);
  }
  void progress(const Progress& progress) override {
    Progress named = progress;
    named.detail = name_ + ": " + progress.detail;
    family_.progress(named);
  }
  bool stop_requested() const override { return family_.stop_requested(); }

 private:
  Monitor& family_;
  std::string name_;
};

/// The result that the member's folder holds, when it is whole.
std::optional<Json> stored_result(const fs::path& folder) {
  if (!fs::exists(folder / "result.json")) {
    return std::nullopt;
  }
  Json json = parse_json(read_file(folder / "result.json"));
  if (!json.is_object()) {
    return std::nullopt;
  }
  return json;
}

store::StudyStore open_store(const case_data::Case& member,
                             const fs::path& folder,
                             const FamilyOptions& options) {
  bool same = false;
  if (options.resume && fs::exists(folder / "study.sqlite")) {
    same = store::StudyStore::read(folder.string()).meta().case_hash ==
           member.hash;
  }
  return open_run(member, folder, same ? RunBegins::Resumed : RunBegins::Anew,
                  options.program_version);
}

/// Of all that a member's answer depends on but where it starts.
std::string fingerprint_of(const FamilyOptions& options,
                           const case_data::Case& member) {
  return files::content_hash(options.program_version + member.answer_hash);
}

class FamilyRun {
 public:
  FamilyRun(const case_data::Case& family, const FamilyOptions& options)
      : family_(family),
        options_(options),
        monitor_(options.monitor != nullptr ? *options.monitor
                                            : silent_monitor()),
        lock_(options.folder.string()),
        limit_(
            study::smaller_limit(options.time_limit, family.study.time_limit)),
        members_(reader::family_cases(family)) {}

  FamilyResult run();

 private:
  void prepare();
  void run_wave(const std::vector<int>& wave);
  void work(const std::vector<int>& wave, std::atomic<std::size_t>& next);
  void size(std::size_t k);
  Json study(std::size_t k, const std::optional<VectorX>& start);
  std::optional<Json> finished_result(std::size_t k) const;
  std::map<int, int> find_finished();
  Json compute(const case_data::Case& member, const fs::path& folder,
               store::StudyStore& store, const study::StudyOptions& options);
  study::StudyListener listener_of(std::size_t k) const;
  std::optional<VectorX> start_of(std::size_t k) const;
  Json fingerprint(std::size_t k, const std::optional<VectorX>& start) const;
  void finish(std::size_t k, const Json& result);
  void write_table();
  void tell();
  double time_left() const;

  const case_data::Case& family_;
  const FamilyOptions& options_;
  Monitor& monitor_;
  store::RunLock lock_;
  Timer timer_;
  double limit_;  // [s], 0: none
  std::vector<case_data::Case> members_;
  std::vector<int> parents_;  // -1: none
  FamilyResult result_;
  std::mutex mutex_;  // of all below and of result_.rows while threads run
  std::exception_ptr error_;
  std::atomic<bool> stopping_{false};
  std::vector<std::vector<std::string>> told_;  // files, by member
  int finished_ = 0;
  int computed_ = 0;      // of these not only read
  double seconds_ = 0.0;  // that computing them took
};

double FamilyRun::time_left() const { return limit_ - timer_.seconds(); }

void FamilyRun::prepare() {
  remove_leftovers(options_.folder);
  // An older result must not stand beside a study that is not its own.
  const fs::path database = options_.folder / "study.sqlite";
  const bool was_run = fs::exists(database);
  remove_owned_files(options_.folder, was_run);
  if (was_run) {
    frames::remove_frames(options_.folder);
  }
  fs::remove(database);
  fs::remove(options_.folder / "result.json");
  parents_.assign(members_.size(), -1);
  told_.assign(members_.size(), {});
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const std::string& name = family_.study.members[k].name;
    FamilyRow row;
    row.name = name;
    row.folder = "members/" + name;
    row.status = "waiting";
    result_.rows.push_back(std::move(row));
  }
}

/// The parent's answer by name, clipped to this member's bounds.
std::optional<VectorX> FamilyRun::start_of(std::size_t k) const {
  if (parents_[k] < 0) {
    return std::nullopt;
  }
  const FamilyRow& parent = result_.rows[static_cast<std::size_t>(parents_[k])];
  const std::vector<case_data::DesignVariable>& design = members_[k].design;
  if (!parent.is_converged() || parent.design.size() != design.size()) {
    return std::nullopt;
  }
  VectorX start(std::ssize(design));
  for (std::size_t i = 0; i < design.size(); ++i) {
    start[static_cast<Eigen::Index>(i)] =
        std::clamp(parent.design[i].second, design[i].lower, design[i].upper);
  }
  return start;
}

/// What this member's answer comes from: a finished one of the same is read
/// and not computed again.
Json FamilyRun::fingerprint(std::size_t k,
                            const std::optional<VectorX>& start) const {
  const std::string& name = family_.study.members[k].name;
  Json json = {
      {"name", name},
      {"parent",
       start ? result_.rows[static_cast<std::size_t>(parents_[k])].name : ""},
      {"fingerprint", fingerprint_of(options_, members_[k])},
      {"start", Json::array()}};
  if (start) {
    json["start"] = std::vector<double>(start->begin(), start->end());
  }
  return json;
}

Json FamilyRun::compute(const case_data::Case& member, const fs::path& folder,
                        store::StudyStore& store,
                        const study::StudyOptions& options) {
  study::RunResult result;
  try {
    forward::EvaluationFields fields;
    result = study::run_study(member, store, options, &fields);
    if (options_.write_files) {
      const Timer timer;
      options_.write_files(member, fields, folder, result);
      result.output_seconds = timer.seconds();
      result.total_seconds += result.output_seconds;
    }
  } catch (const study::TimeIsUp& late) {
    result = study::result_so_far(member, store.all());
    result.status = study::RunStatus::Stopped;
    result.message = late.what();
  } catch (const Interrupted&) {
    result = study::result_so_far(member, store.all());
    result.status = study::RunStatus::Interrupted;
    result.message = fmt::format(
        "{} finished evaluations are kept, go on with --resume", store.size());
    stopping_ = true;
  } catch (const IoError&) {
    throw;
  } catch (const Error& error) {
    result = study::result_so_far(member, store.all());
    result.status = study::RunStatus::Failed;
    result.message = error.what();
  }
  write_file(folder / "history.csv", store::history_csv(store.all()));
  return result_json(member, result, options_.program_version);
}

/// The member's result where it is finished: it stays what it is, whatever it
/// started from, though the family has other members now.
std::optional<Json> FamilyRun::finished_result(std::size_t k) const {
  if (!options_.resume) {
    return std::nullopt;
  }
  const std::string& name = family_.study.members[k].name;
  std::optional<Json> known = stored_result(options_.folder / "members" / name);
  if (!known) {
    return std::nullopt;
  }
  const Json member = known->value("member", Json::object());
  const bool same =
      member.value("name", "") == name &&
      member.value("fingerprint", "") == fingerprint_of(options_, members_[k]);
  const std::string status = known->value("status", "");
  if (!same || status == "stopped" || status == "interrupted") {
    return std::nullopt;
  }
  return known;
}

/// Finished members with the parents that they have: the tree grows on them.
/// One whose parent is gone, or has to begin again, keeps its answer and stands
/// at a root.
std::map<int, int> FamilyRun::find_finished() {
  std::map<int, int> finished;
  std::map<std::string, int> by_name;
  std::vector<std::string> parents(members_.size());
  for (std::size_t k = 0; k < members_.size(); ++k) {
    if (const std::optional<Json> known = finished_result(k)) {
      parents[k] = (*known)["member"].value("parent", "");
      by_name[family_.study.members[k].name] = static_cast<int>(k);
      finished[static_cast<int>(k)] = -1;
    }
  }
  for (auto& [member, parent] : finished) {
    const auto at = by_name.find(parents[static_cast<std::size_t>(member)]);
    parent = at == by_name.end() ? -1 : at->second;
  }
  return finished;
}

/// The family's, told whose event it is.
study::StudyListener FamilyRun::listener_of(std::size_t k) const {
  if (!options_.listener) {
    return {};
  }
  return
      [this, name = result_.rows[k].name](const study::EvaluationEvent& event) {
        study::EvaluationEvent named = event;
        named.member = name;
        options_.listener(named);
      };
}

/// The member's result, read or computed and written.
Json FamilyRun::study(std::size_t k, const std::optional<VectorX>& start) {
  const case_data::Case& member = members_[k];
  const fs::path folder = options_.folder / result_.rows[k].folder;
  make_folder(folder);
  if (const std::optional<Json> known = finished_result(k)) {
    return *known;
  }
  store::StudyStore store = open_store(member, folder, options_);
  MemberMonitor monitor(monitor_, result_.rows[k].name);
  const Timer timer;
  Json json = compute(
      member, folder, store,
      {.time_limit = limit_ > 0.0 ? std::max(time_left(), kLeastTime) : 0.0,
       .frames = options_.frames,
       .start = start,
       .listener = listener_of(k),
       .monitor = &monitor});
  json["member"] = fingerprint(k, start);
  write_file(folder / "result.json", json_text(json, 2) + "\n");
  const std::lock_guard<std::mutex> guard(mutex_);
  ++computed_;
  seconds_ += timer.seconds();
  return json;
}

void FamilyRun::finish(std::size_t k, const Json& result) {
  FamilyRow row = family_row(members_[k], result);
  const std::lock_guard<std::mutex> guard(mutex_);
  row.name = result_.rows[k].name;
  row.folder = result_.rows[k].folder;
  row.parent = result["member"].value("parent", "");
  told_[k].clear();
  for (const Json& warning : result.value("warnings", Json::array())) {
    const std::string text = warning.is_string() ? warning : "";
    // Asked for and not there; held above what was asked.
    if (text.rfind(kNotWritten, 0) == 0 || text.ends_with(study::kHeldAbove)) {
      told_[k].push_back(row.name + ": " + text);
    }
  }
  result_.rows[k] = std::move(row);
  ++finished_;
  write_table();
  tell();
}

void FamilyRun::size(std::size_t k) {
  if (limit_ > 0.0 && time_left() <= 0.0) {
    const std::lock_guard<std::mutex> guard(mutex_);
    result_.rows[k].status = "stopped";
    result_.rows[k].message = "the time limit was reached before it began";
    return;
  }
  finish(k, study(k, start_of(k)));
}

void FamilyRun::write_table() {
  write_file(options_.folder / "family.csv", family_csv(result_.rows));
}

void FamilyRun::tell() {
  std::string detail =
      fmt::format("{} of {} members done", finished_, members_.size());
  const auto left = static_cast<double>(members_.size()) - finished_;
  if (computed_ > 0 && left > 0) {
    detail += fmt::format(", about {:.0f} s left",
                          seconds_ / computed_ * left / options_.jobs);
  }
  monitor_.progress({.stage = "family", .detail = detail});
}

/// Members of the wave until none is left or something is wrong.
void FamilyRun::work(const std::vector<int>& wave,
                     std::atomic<std::size_t>& next) {
  try {
    for (std::size_t k = next++; k < wave.size() && !stopping_; k = next++) {
      size(static_cast<std::size_t>(wave[k]));
    }
  } catch (...) {
    const std::lock_guard<std::mutex> guard(mutex_);
    error_ = error_ ? error_ : std::current_exception();
    stopping_ = true;
  }
}

void FamilyRun::run_wave(const std::vector<int>& wave) {
  std::atomic<std::size_t> next{0};
  const int jobs = std::min(options_.jobs, static_cast<int>(wave.size()));
  if (jobs <= 1) {
    work(wave, next);
  } else {
    std::vector<std::thread> threads;
    threads.reserve(static_cast<std::size_t>(jobs));
    for (int job = 0; job < jobs; ++job) {
      threads.emplace_back([&] {
        omp_set_num_threads(std::max(1, options_.threads / jobs));
        work(wave, next);
      });
    }
    for (std::thread& thread : threads) {
      thread.join();
    }
  }
  if (error_) {
    std::rethrow_exception(error_);
  }
}

FamilyResult FamilyRun::run() {
  prepare();
  std::vector<VectorX> numbers;
  numbers.reserve(members_.size());
  for (const case_data::Case& member : members_) {
    numbers.push_back(reader::member_numbers(member));
  }
  const std::vector<samples::FamilyStep> steps =
      samples::family_tree(numbers, find_finished());
  if (family_.study.kind !=
      case_data::StudyKind::Analyse) {  // that has no start
    for (const samples::FamilyStep& step : steps) {
      parents_[static_cast<std::size_t>(step.member)] =
          step.parent.value_or(-1);
    }
  }
  write_table();
  tell();
  for (const std::vector<int>& wave : samples::family_waves(steps)) {
    if (!stopping_) {
      run_wave(wave);
    }
  }
  set_status(result_);
  for (const std::vector<std::string>& files : told_) {
    result_.warnings.insert(result_.warnings.end(), files.begin(), files.end());
  }
  if (stopping_) {
    result_.status = study::RunStatus::Interrupted;
  }
  result_.total_seconds = timer_.seconds();
  write_table();
  write_file(
      options_.folder / "result.json",
      json_text(family_json(family_, result_, options_.program_version), 2) +
          "\n");
  return std::move(result_);
}

}  // namespace

FamilyResult run_family(const case_data::Case& family,
                        const FamilyOptions& options) {
  return FamilyRun(family, options).run();
}

}  // namespace meniscus::results
