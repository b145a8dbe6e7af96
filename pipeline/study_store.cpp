#include "pipeline/study_store.h"

#include <bit>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <system_error>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/run_lock.h"
#include "pipeline/study_store_sqlite.h"

namespace meniscus {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little,
              "doubles are stored in the machine's own order");

constexpr int kSchemaVersion = 1;
constexpr int kApplicationId = 0x4d6e7363;  // "Mnsc", in the file's header
constexpr const char* kFile = "study.sqlite";

// While somebody writes, a log stands beside the file; see the header.
constexpr const char* kDurable =
    "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL";
constexpr const char* kOnePlainFile = "PRAGMA journal_mode = DELETE";

constexpr const char* kSchema = R"(
CREATE TABLE meta (program_version TEXT, case_hash TEXT, case_text TEXT,
                   created TEXT);
CREATE TABLE evaluation (
  number INTEGER PRIMARY KEY, key BLOB NOT NULL, model TEXT NOT NULL,
  phase TEXT NOT NULL, input_names TEXT NOT NULL, inputs BLOB NOT NULL,
  response_names TEXT NOT NULL, responses BLOB NOT NULL, gradient BLOB,
  mismatch REAL, failure TEXT, failure_message TEXT, figures TEXT NOT NULL,
  seconds TEXT NOT NULL);
CREATE INDEX evaluation_key ON evaluation (key);
)";

constexpr const char* kColumns =
    "number, model, phase, input_names, inputs, response_names, responses, "
    "gradient, mismatch, failure, failure_message, figures, seconds";

std::string to_bytes(const double* data, Eigen::Index size) {
  std::string bytes(static_cast<std::size_t>(size) * sizeof(double), '\0');
  if (size > 0) {
    std::memcpy(bytes.data(), data, bytes.size());
  }
  return bytes;
}

VectorX to_vector(const std::string& bytes) {
  VectorX values(static_cast<Eigen::Index>(bytes.size() / sizeof(double)));
  if (values.size() > 0) {
    std::memcpy(values.data(), bytes.data(),
                static_cast<std::size_t>(values.size()) * sizeof(double));
  }
  return values;
}

std::string key_of(const std::string& case_hash, const std::string& model,
                   const VectorX& inputs) {
  // + 0 turns -0 into 0: one design, one key.
  const VectorX point = (inputs.array() + 0.0).matrix();
  return case_hash + '\0' + model + '\0' + to_bytes(point.data(), point.size());
}

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

void check_health(const SqliteDatabase& database) {
  SqliteStatement check(database, "PRAGMA quick_check(1)");
  const std::string verdict = check.step() ? check.bytes(0) : "no answer";
  if (verdict != "ok") {
    database.fail_damaged(verdict);
  }
}

void create_schema(const SqliteDatabase& database, const StudyMeta& meta) {
  database.execute(kDurable);
  database.execute("BEGIN IMMEDIATE");
  database.execute(kSchema);
  database.execute(
      fmt::format("PRAGMA application_id = {}; "
                  "PRAGMA user_version = {}",
                  kApplicationId, kSchemaVersion));
  SqliteStatement row(database, "INSERT INTO meta VALUES (?, ?, ?, ?)");
  row.bind(meta.program_version);
  row.bind(meta.case_hash);
  row.bind(meta.case_text);
  row.bind(now());
  row.step();
  database.execute("COMMIT");
}

StudyMeta read_meta(const SqliteDatabase& database) {
  SqliteStatement row(database,
                      "SELECT program_version, case_hash, case_text, created "
                      "FROM meta");
  if (!row.step()) {
    database.fail_damaged("its table meta is empty");
  }
  return {.schema_version = kSchemaVersion,
          .program_version = row.bytes(0),
          .case_hash = row.bytes(1),
          .case_text = row.bytes(2),
          .created = row.bytes(3)};
}

Json parsed(const SqliteDatabase& database, const std::string& text) {
  Json value = Json::parse(text, nullptr, false);
  if (value.is_discarded()) {
    database.fail_damaged("not JSON: " + text.substr(0, 40));
  }
  return value;
}

std::string to_text(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

EvaluationRecord read_record(const SqliteDatabase& database,
                             SqliteStatement& row) {
  EvaluationRecord record;
  record.number = row.integer(0);
  record.model = row.bytes(1);
  record.phase = row.bytes(2);
  record.input_names = parsed(database, row.bytes(3));
  record.inputs = to_vector(row.bytes(4));
  record.response_names = parsed(database, row.bytes(5));
  record.responses = to_vector(row.bytes(6));
  const VectorX gradient = to_vector(row.bytes(7));
  if (gradient.size() > 0 && record.inputs.size() > 0) {
    record.gradient = gradient.reshaped(gradient.size() / record.inputs.size(),
                                        record.inputs.size());
  }
  if (!row.is_null(8)) {
    record.mismatch = row.number(8);
  }
  if (!row.is_null(9)) {
    record.failure = Failure{failure_kind_of(row.bytes(9)), row.bytes(10)};
  }
  record.figures = row.bytes(11);
  const Json seconds = parsed(database, row.bytes(12));
  for (const auto& [stage, value] : seconds.items()) {
    record.seconds.emplace_back(stage,
                                value.is_number() ? value.get<double>() : 0.0);
  }
  return record;
}

void check_record(const EvaluationRecord& record) {
  const auto inputs = static_cast<Eigen::Index>(record.input_names.size());
  const auto responses =
      static_cast<Eigen::Index>(record.response_names.size());
  const bool fits =
      record.inputs.size() == inputs &&
      (record.responses.size() == responses ||
       (record.failure && record.responses.size() == 0)) &&
      (record.gradient.size() == 0 || (record.gradient.rows() == responses &&
                                       record.gradient.cols() == inputs));
  if (!fits) {
    throw InvalidInput(fmt::format(
        "study: a record of {} inputs with {} names, {} responses with {} "
        "names and a {} x {} gradient does not fit together",
        record.inputs.size(), inputs, record.responses.size(), responses,
        record.gradient.rows(), record.gradient.cols()));
  }
}

// Renames a study that is there to the first free study-<n>.sqlite. Its log
// is folded in first; one that cannot be (damaged) goes along.
void set_aside(const fs::path& folder, const StudyStoreOptions& options) {
  const fs::path current = folder / kFile;
  if (!fs::exists(current)) {
    return;
  }
  {
    const SqliteDatabase old(current.string(), SqliteDatabase::Access::Write,
                             options.busy_timeout);
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
    if (lock) {  // back to one plain file; in vain while somebody reads
      database.try_execute(kOnePlainFile);
    }
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::optional<RunLock> lock;  // released after the database is closed
  SqliteDatabase database;
  StudyMeta meta;
};

StudyStore::StudyStore(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StudyStore::~StudyStore() = default;
StudyStore::StudyStore(StudyStore&&) noexcept = default;
StudyStore& StudyStore::operator=(StudyStore&&) noexcept = default;

StudyStore StudyStore::start(const std::string& folder, const StudyMeta& meta,
                             const StudyStoreOptions& options) {
  RunLock lock(folder);
  set_aside(folder, options);
  auto impl = std::make_unique<Impl>(std::move(lock), folder,
                                     SqliteDatabase::Access::Write, options);
  create_schema(impl->database, meta);
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
    database.execute(kDurable);
  }
  impl->meta = read_meta(database);
  if (impl->meta.case_hash != meta.case_hash) {
    throw InvalidInput(fmt::format(
        "{} belongs to another case or to other --set values (hash {}, now "
        "{}); restore them, or run without --resume: the file is then kept "
        "under another name",
        database.path(), impl->meta.case_hash, meta.case_hash));
  }
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
  check_record(record);
  SqliteStatement row(impl_->database,
                      "INSERT INTO evaluation VALUES "
                      "(NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  const auto bind_doubles = [&row](const double* data, Eigen::Index size) {
    row.bind_bytes(to_bytes(data, size));
  };
  row.bind_bytes(key_of(impl_->meta.case_hash, record.model, record.inputs));
  row.bind(record.model);
  row.bind(record.phase);
  row.bind(to_text(record.input_names));
  bind_doubles(record.inputs.data(), record.inputs.size());
  row.bind(to_text(record.response_names));
  bind_doubles(record.responses.data(), record.responses.size());
  bind_doubles(record.gradient.data(), record.gradient.size());
  row.bind(record.mismatch);
  if (record.failure) {
    row.bind(std::string(name_of(record.failure->kind)));
    row.bind(record.failure->message);
  } else {
    row.bind_null();
    row.bind_null();
  }
  row.bind(record.figures);
  Json seconds = Json::object();
  for (const auto& [stage, value] : record.seconds) {
    seconds[stage] = value;
  }
  row.bind(to_text(seconds));
  row.step();
  return impl_->database.last_row();
}

void StudyStore::set_gradient(int number, const Eigen::MatrixXd& gradient) {
  if (!impl_->lock) {
    throw InvalidInput("study: opened to be read, nothing can be changed");
  }
  SqliteStatement found(
      impl_->database,
      fmt::format("SELECT {} FROM evaluation WHERE number = ?", kColumns));
  found.bind(number);
  if (!found.step()) {
    throw InvalidInput(fmt::format("study: there is no record {}", number));
  }
  EvaluationRecord record = read_record(impl_->database, found);
  record.gradient = gradient;
  check_record(record);
  SqliteStatement row(impl_->database,
                      "UPDATE evaluation SET gradient = ? WHERE number = ?");
  row.bind_bytes(to_bytes(gradient.data(), gradient.size()));
  row.bind(number);
  row.step();
}

std::optional<EvaluationRecord> StudyStore::find(const std::string& model,
                                                 const VectorX& inputs) const {
  SqliteStatement row(impl_->database,
                      fmt::format("SELECT {} FROM evaluation WHERE key = ? "
                                  "ORDER BY number LIMIT 1",
                                  kColumns));
  row.bind_bytes(key_of(impl_->meta.case_hash, model, inputs));
  if (!row.step()) {
    return std::nullopt;
  }
  return read_record(impl_->database, row);
}

int StudyStore::size() const {
  SqliteStatement row(impl_->database, "SELECT count(*) FROM evaluation");
  return row.step() ? row.integer(0) : 0;
}

std::vector<EvaluationRecord> StudyStore::all() const {
  std::vector<EvaluationRecord> records;
  SqliteStatement row(
      impl_->database,
      fmt::format("SELECT {} FROM evaluation ORDER BY number", kColumns));
  while (row.step()) {
    records.push_back(read_record(impl_->database, row));
  }
  return records;
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

}  // namespace meniscus
