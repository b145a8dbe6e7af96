/// The study database of one results folder, FOLDER/study.sqlite: every
/// evaluation, on disk before the next one begins.
///
/// SQLite in WAL mode with synchronous = FULL: a commit is in the log and the
/// log is flushed to the disk when append() returns, so neither kill -9 nor a
/// power cut loses a finished evaluation (NORMAL would survive the kill but
/// not the power cut). After a clean end it is one plain file again.
///
/// Numbers that must come back with the same bits (inputs, responses,
/// gradient) are stored as little-endian IEEE doubles, not as text. Each record
/// has a seal, a hash of all its columns: bytes that changed on the disk are
/// found even where SQLite sees nothing wrong.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/types.h"

namespace meniscus::store {

struct StudyMeta {
  int schema_version = 0;       // set by the store
  std::string program_version;  // that began the study
  std::string case_hash;        // of all that the evaluations depend on
  std::string case_text;        // the case file, word for word
  std::string created;          // UTC, "2026-01-31T12:00:00Z"; set by the store
};

/// The frozen model that a study's answer is of.
inline constexpr const char* kStudyModel = "base";

struct EvaluationRecord {
  int number = 0;                   // from 1; set by append()
  std::string model = kStudyModel;  // another one: of a coarser stage
  std::string phase;                // why: "start", "difference", "step", ...
  std::vector<std::string> input_names;
  VectorX inputs;  // design variables
  std::vector<std::string> response_names;
  VectorX responses;               // empty when there is a failure
  Eigen::MatrixXd gradient;        // d response_i / d input_j, may be empty;
                                   // NaN in rows that nobody asked for
  std::optional<double> mismatch;  // the largest, for people and history.csv
  std::optional<Failure> failure;
  std::string figures = "{}";  // of film, mesh and elasticity, JSON text
  std::vector<std::pair<std::string, double>> seconds;  // by stage [s]
};

struct StudyStoreOptions {
  double busy_timeout = 5.0;  // [s] to wait for a lock on the database
};

/// Messages of IoError: full disk, damaged file (which is left as it is),
/// locked database. InvalidInput: folder in use by another run, database of
/// another schema version or another program, study of another case.
class StudyStore {
 public:
  /// An empty study. One that is there already is not lost: it is renamed to
  /// study-1.sqlite, study-2.sqlite, ... (the first free number).
  /// Locks the folder against other runs for as long as the store lives.
  static StudyStore start(const std::string& folder, const StudyMeta& meta,
                          const StudyStoreOptions& options = {});

  /// Goes on with the study in the folder, which must be of the same case
  /// hash; an empty one when there is none. Locks the folder likewise.
  /// Replay is by find(): an evaluation is a pure function of its key.
  static StudyStore resume(const std::string& folder, const StudyMeta& meta,
                           const StudyStoreOptions& options = {});

  /// To look at, also while a run is writing; append() throws InvalidInput.
  static StudyStore read(const std::string& folder,
                         const StudyStoreOptions& options = {});

  ~StudyStore();
  StudyStore(StudyStore&&) noexcept;
  StudyStore& operator=(StudyStore&&) noexcept;

  /// As stored; program_version may be another one than this program's, and
  /// then bits may differ: a caller that resumes should warn.
  const StudyMeta& meta() const;

  /// Commits the record and returns its number.
  int append(const EvaluationRecord& record);

  /// Adds (or replaces) the gradient of record `number`, committed likewise:
  /// rows by response, NaN in those that are not known. Throws InvalidInput
  /// for a gradient of another shape or a number that is not there.
  void set_gradient(int number, const Eigen::MatrixXd& gradient);

  /// The first record of this case hash, model and exact bits of inputs.
  std::optional<EvaluationRecord> find(const std::string& model,
                                       const VectorX& inputs) const;

  int size() const;
  std::vector<EvaluationRecord> all() const;  // by number
  /// Those of `numbers`, in that order; throws InvalidInput for one that is not
  /// there.
  std::vector<EvaluationRecord> some(const std::vector<int>& numbers) const;

 private:
  struct Impl;
  explicit StudyStore(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// What the evaluation was for, for people: its phase, after the model's name
/// where that is not the study's own.
std::string purpose_of(const EvaluationRecord& record);

/// The kind that name_of() writes as `name`; throws IoError for no kind.
FailureKind failure_kind_of(const std::string& name);

}  // namespace meniscus::store
