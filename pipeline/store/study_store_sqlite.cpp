#include "pipeline/store/study_store_sqlite.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sqlite3.h>

#include "core/error.h"

namespace meniscus::store {
namespace {

std::string damaged(const std::string& path, const std::string& how) {
  return fmt::format(
      "{} is damaged ({}); it is left as it is. Restore a copy, or run without "
      "--resume: the file is then kept under another name",
      path, how);
}

// SQLite has a code of its own for a full disk, but reports a quota or a
// limit on file size as a failed write.
bool is_disk_full(int code) {
  return (code & 0xff) == SQLITE_FULL || code == SQLITE_IOERR_WRITE ||
         code == SQLITE_IOERR_SHMSIZE;
}

}  // namespace

SqliteDatabase::SqliteDatabase(std::string path, Access access,
                               double busy_timeout)
    : path_(std::move(path)), busy_timeout_(busy_timeout) {
  const int flags = access == Access::Read
                        ? SQLITE_OPEN_READONLY
                        : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  if (sqlite3_open_v2(path_.c_str(), &handle_, flags, nullptr) != SQLITE_OK) {
    const std::string message = explain("opened");
    sqlite3_close(handle_);
    throw IoError(message);
  }
  sqlite3_extended_result_codes(handle_, 1);
  sqlite3_busy_timeout(handle_, static_cast<int>(1000.0 * busy_timeout_));
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
}

SqliteDatabase::~SqliteDatabase() { sqlite3_close(handle_); }

void SqliteDatabase::execute(const std::string& sql) const {
  if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) !=
      SQLITE_OK) {
    fail("written");
  }
}

void SqliteDatabase::try_execute(const std::string& sql) const noexcept {
  sqlite3_busy_timeout(handle_, 0);
  sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  sqlite3_busy_timeout(handle_, static_cast<int>(1000.0 * busy_timeout_));
}

void SqliteDatabase::fold_log_on_close() const noexcept {
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 0, nullptr);
}

int SqliteDatabase::pragma(const std::string& name) const {
  SqliteStatement statement(*this, "PRAGMA " + name);
  return statement.step() ? statement.integer(0) : 0;
}

int SqliteDatabase::last_row() const {
  return static_cast<int>(sqlite3_last_insert_rowid(handle_));
}

void SqliteDatabase::fail(const char* what) const {
  throw IoError(explain(what));
}

void SqliteDatabase::fail_damaged(const std::string& how) const {
  throw IoError(damaged(path_, how));
}

std::string SqliteDatabase::explain(const char* what) const {
  if (handle_ == nullptr) {
    return fmt::format("{} cannot be {}: out of memory", path_, what);
  }
  const int code = sqlite3_extended_errcode(handle_);
  const std::string text = sqlite3_errmsg(handle_);
  if (is_disk_full(code)) {
    return fmt::format(
        "disk full while writing {} (or over a quota or a limit on file size: "
        "{}); what was finished is kept: free some space and run again with "
        "--resume",
        path_, text);
  }
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return fmt::format(
          "{} is locked by another program (waited {} s); close what has it "
          "open and run again with --resume",
          path_, busy_timeout_);
    case SQLITE_ERROR:  // our own statements are right: its tables are not
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
      return damaged(path_, text);
    default:
      break;
  }
  const int system = sqlite3_system_errno(handle_);
  return fmt::format(
      "{} cannot be {}: {}{}", path_, what, text,
      system == 0 ? "" : ", " + std::generic_category().message(system));
}

SqliteStatement::SqliteStatement(const SqliteDatabase& database,
                                 const std::string& sql)
    : database_(database) {
  if (sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &handle_,
                         nullptr) != SQLITE_OK) {
    database.fail("read");
  }
}

SqliteStatement::~SqliteStatement() { sqlite3_finalize(handle_); }

void SqliteStatement::bind(const std::string& text) {
  sqlite3_bind_text(handle_, ++bound_, text.data(),
                    static_cast<int>(text.size()), SQLITE_TRANSIENT);
}

void SqliteStatement::bind(const std::optional<double>& number) {
  ++bound_;  // what is not bound is NULL
  if (number) {
    sqlite3_bind_double(handle_, bound_, *number);
  }
}

void SqliteStatement::bind_bytes(const std::string& bytes) {
  sqlite3_bind_blob(handle_, ++bound_, bytes.data(),
                    static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
}

void SqliteStatement::bind_null() { ++bound_; }

bool SqliteStatement::step() {
  const int code = sqlite3_step(handle_);
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    database_.fail("read or written");
  }
  return code == SQLITE_ROW;
}

bool SqliteStatement::is_null(int column) {
  return sqlite3_column_type(handle_, column) == SQLITE_NULL;
}

int SqliteStatement::integer(int column) {
  return sqlite3_column_int(handle_, column);
}

double SqliteStatement::number(int column) {
  return sqlite3_column_double(handle_, column);
}

std::string SqliteStatement::bytes(int column) {
  const void* data = sqlite3_column_blob(handle_, column);
  const int size = sqlite3_column_bytes(handle_, column);
  return data == nullptr ? std::string()
                         : std::string(static_cast<const char*>(data),
                                       static_cast<std::size_t>(size));
}

}  // namespace meniscus::store
