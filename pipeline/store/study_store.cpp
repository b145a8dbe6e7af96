#include "pipeline/store/study_store.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <system_error>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "pipeline/store/run_lock.h"
#include "pipeline/store/study_rows.h"
#include "pipeline/store/study_store_sqlite.h"

namespace meniscus::store {
namespace {

namespace fs = std::filesystem;

constexpr int kSchemaVersion = 2;
constexpr int kApplicationId = 0x4d6e7363;  // "Mnsc", in the file's header
constexpr const char* kFile = "study.sqlite";

// While somebody writes, a log stands beside the file; see the header.
constexpr const char* kDurable =
    "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL";
constexpr const char* kOnePlainFile = "PRAGMA journal_mode = DELETE";

constexpr const char* kMetaTable = R"(
CREATE TABLE meta (program_version TEXT, case_hash TEXT, case_text TEXT,
                   created TEXT, seal TEXT);
)";

std::string now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(
                         std::chrono::system_clock::now())));
}

// A kill between the creation of the file and the commit of its schema leaves
// a database without tables: as good as none.
bool is_blank(const SqliteDatabase& database) {
  SqliteStatement tables(database, "SELECT count(*) FROM sqlite_master");
  return tables.step() && tables.integer(0) == 0 &&
         database.pragma("user_version") == 0;
}

void check_kind(const SqliteDatabase& database) {
  if (database.pragma("application_id") != kApplicationId) {
    throw InvalidInput(fmt::format(
        "{} is a database of another program; move it away, or choose "
        "another folder with --out",
        database.path()));
  }
  const int version = database.pragma("user_version");
  if (version != kSchemaVersion) {
    throw InvalidInput(fmt::format(
        "{} has schema version {}, this program reads version {}; use the "
        "program that wrote it, or run without --resume: the file is then "
        "kept under another name",
        database.path(), version, kSchemaVersion));
  }
}

/// SQLite's own structure, every record and the case.
void check_health(const SqliteDatabase& database) {
  SqliteStatement check(database, "PRAGMA integrity_check(1)");
  const std::string verdict = check.step() ? check.bytes(0) : "no answer";
  if (verdict != "ok") {
    database.fail_damaged(verdict);
  }
  select_rows(database, "");
}

void create_schema(const SqliteDatabase& database, const StudyMeta& meta) {
  database.execute(kDurable);
  database.execute("BEGIN IMMEDIATE");
  database.execute(kMetaTable);
  database.execute(kEvaluationTable);
  database.execute(
      fmt::format("PRAGMA application_id = {}; "
                  "PRAGMA user_version = {}",
                  kApplicationId, kSchemaVersion));
  const std::string created = now();
  SqliteStatement row(database, "INSERT INTO meta VALUES (?, ?, ?, ?, ?)");
  row.bind(meta.program_version);
  row.bind(meta.case_hash);
  row.bind(meta.case_text);
  row.bind(created);
  row.bind(checksum_of(
      {meta.program_version, meta.case_hash, meta.case_text, created}));
  row.step();
  database.execute("COMMIT");
}

StudyMeta read_meta(const SqliteDatabase& database) {
  SqliteStatement row(database,
                      "SELECT program_version, case_hash, case_text, created, "
                      "seal FROM meta");
  if (!row.step()) {
    database.fail_damaged("its table meta is empty");
  }
  StudyMeta meta{.schema_version = kSchemaVersion,
                 .program_version = row.bytes(0),
                 .case_hash = row.bytes(1),
                 .case_text = row.bytes(2),
                 .created = row.bytes(3)};
  if (row.bytes(4) != checksum_of({meta.program_version, meta.case_hash,
                                   meta.case_text, meta.created})) {
    database.fail_damaged("what it says of its case is not what was written");
  }
  return meta;
}

// Renames a study that is there to the first free study-<n>.sqlite. Its log
// is folded in first; one that cannot be (damaged) goes along.
void archive_existing(const fs::path& folder,
                      const StudyStoreOptions& options) {
  const fs::path current = folder / kFile;
  if (!fs::exists(current)) {
    return;
  }
  {
    const SqliteDatabase old(current.string(), SqliteDatabase::Access::Write,
                             options.busy_timeout);
    old.fold_log_on_close();
    old.try_execute(kOnePlainFile);
  }
  int n = 1;
  const auto numbered = [&](const char* tail) {
    return folder / fmt::format("study-{}.sqlite{}", n, tail);
  };
  while (fs::exists(numbered("")) || fs::exists(numbered("-wal"))) {
    ++n;
  }
  for (const char* tail : {"-wal", ""}) {
    const fs::path from = current.string() + tail;
    std::error_code code;
    if (fs::exists(from)) {
      fs::rename(from, numbered(tail), code);
    }
    if (code) {
      throw IoError(fmt::format("{} cannot be renamed to {}: {}", from.string(),
                                numbered(tail).string(), code.message()));
    }
  }
  fs::remove(current.string() + "-shm");
}

}  // namespace

struct StudyStore::Impl {
  Impl(std::optional<RunLock> run_lock, const std::string& folder,
       SqliteDatabase::Access access, const StudyStoreOptions& options)
      : lock(std::move(run_lock)),
        database((fs::path(folder) / kFile).string(), access,
                 options.busy_timeout) {}
  ~Impl() {
    if (valid) {  // back to one plain file; in vain while somebody reads
      database.try_execute(kOnePlainFile);
    }
  }
  /// From now on the file may change, beyond what was found in it.
  void accept() {
    valid = true;
    database.fold_log_on_close();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::optional<RunLock> lock;  // released after the database is closed
  SqliteDatabase database;
  bool valid = false;  // checked and ours
  StudyMeta meta;
};

StudyStore::StudyStore(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StudyStore::~StudyStore() = default;
StudyStore::StudyStore(StudyStore&&) noexcept = default;
StudyStore& StudyStore::operator=(StudyStore&&) noexcept = default;

StudyStore StudyStore::start(const std::string& folder, const StudyMeta& meta,
                             const StudyStoreOptions& options) {
  RunLock lock(folder);
  archive_existing(folder, options);
  auto impl = std::make_unique<Impl>(std::move(lock), folder,
                                     SqliteDatabase::Access::Write, options);
  create_schema(impl->database, meta);
  impl->accept();
  impl->meta = read_meta(impl->database);
  return StudyStore(std::move(impl));
}

StudyStore StudyStore::resume(const std::string& folder, const StudyMeta& meta,
                              const StudyStoreOptions& options) {
  RunLock lock(folder);
  auto impl = std::make_unique<Impl>(std::move(lock), folder,
                                     SqliteDatabase::Access::Write, options);
  const SqliteDatabase& database = impl->database;
  if (is_blank(database)) {
    create_schema(database, meta);
  } else {
    check_kind(database);
    check_health(database);
  }
  impl->meta = read_meta(database);
  if (impl->meta.case_hash != meta.case_hash) {
    throw InvalidInput(fmt::format(
        "{} belongs to another case or to other --set values (hash {}, now "
        "{}); restore them, or run without --resume: the file is then kept "
        "under another name",
        database.path(), impl->meta.case_hash, meta.case_hash));
  }
  database.execute(kDurable);
  database.execute("BEGIN IMMEDIATE; COMMIT");  // better now than hours later
  impl->accept();
  return StudyStore(std::move(impl));
}

StudyStore StudyStore::read(const std::string& folder,
                            const StudyStoreOptions& options) {
  const fs::path path = fs::path(folder) / kFile;
  if (!fs::exists(path)) {
    throw IoError(fmt::format(
        "no study in '{}': {} is not there; give the results folder of a run",
        folder, path.string()));
  }
  auto impl = std::make_unique<Impl>(std::nullopt, folder,
                                     SqliteDatabase::Access::Read, options);
  if (is_blank(impl->database)) {
    throw IoError(fmt::format("{} holds no study yet; the run has only begun",
                              path.string()));
  }
  check_kind(impl->database);
  impl->meta = read_meta(impl->database);
  return StudyStore(std::move(impl));
}

const StudyMeta& StudyStore::meta() const { return impl_->meta; }

int StudyStore::append(const EvaluationRecord& record) {
  if (!impl_->lock) {
    throw InvalidInput("study: opened to be read, nothing can be appended");
  }
  return insert_row(impl_->database, impl_->meta.case_hash, record);
}

void StudyStore::set_gradient(int number, const Eigen::MatrixXd& gradient) {
  if (!impl_->lock) {
    throw InvalidInput("study: opened to be read, nothing can be changed");
  }
  replace_gradient(impl_->database, number, gradient);
}

std::optional<EvaluationRecord> StudyStore::find(const std::string& model,
                                                 const VectorX& inputs) const {
  const std::vector<EvaluationRecord> found =
      select_rows(impl_->database, "WHERE key = ?",
                  key_of(impl_->meta.case_hash, model, inputs));
  return found.empty() ? std::nullopt : std::optional(found.front());
}

int StudyStore::size() const {
  SqliteStatement row(impl_->database, "SELECT count(*) FROM evaluation");
  return row.step() ? row.integer(0) : 0;
}

std::vector<EvaluationRecord> StudyStore::all() const {
  return select_rows(impl_->database, "");
}

std::vector<EvaluationRecord> StudyStore::some(
    const std::vector<int>& numbers) const {
  const std::vector<EvaluationRecord> records = all();
  std::vector<EvaluationRecord> found;
  found.reserve(numbers.size());
  for (const int number : numbers) {
    const auto at = std::lower_bound(
        records.begin(), records.end(), number,
        [](const EvaluationRecord& r, int n) { return r.number < n; });
    if (at == records.end() || at->number != number) {
      throw InvalidInput(fmt::format("study: there is no record {}", number));
    }
    found.push_back(*at);
  }
  return found;
}

std::string purpose_of(const EvaluationRecord& record) {
  return record.model == kStudyModel ? record.phase
                                     : record.model + " " + record.phase;
}

FailureKind failure_kind_of(const std::string& name) {
  for (int i = 0; i <= static_cast<int>(FailureKind::NotANumber); ++i) {
    const auto kind = static_cast<FailureKind>(i);
    if (name == name_of(kind)) {
      return kind;
    }
  }
  throw IoError("study: failure kind '" + name + "' is not known");
}

}  // namespace meniscus::store
