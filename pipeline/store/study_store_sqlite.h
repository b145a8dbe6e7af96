/// The two SQLite objects that the study store works with. Nothing but the
/// study store includes this.
#pragma once

#include <optional>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace meniscus::store {

/// One open database file. What SQLite refuses becomes an IoError that names
/// the file and what to do: full disk, damaged, locked, not accessible.
class SqliteDatabase {
 public:
  enum class Access { Read, Write };  // Write creates a missing file

  /// `busy_timeout` [s]: how long to wait for another program's lock.
  SqliteDatabase(std::string path, Access access, double busy_timeout);
  ~SqliteDatabase();
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  const std::string& path() const { return path_; }
  sqlite3* handle() const { return handle_; }
  void execute(const std::string& sql) const;  // one or more statements
  /// A log beside the file stays as it is when this closes, for a file that
  /// turns out to be damaged must not change; called, it is folded in.
  void fold_log_on_close() const noexcept;
  /// As execute() without waiting; a refusal changes nothing and is no error.
  void try_execute(const std::string& sql) const noexcept;
  int pragma(const std::string& name) const;  // 0 when it has no value
  int last_row() const;                       // number of the last insertion
  /// Throws for SQLite's last error; `what` completes "cannot be ...".
  [[noreturn]] void fail(const char* what) const;
  [[noreturn]] void fail_damaged(const std::string& how) const;

 private:
  std::string explain(const char* what) const;

  std::string path_;
  double busy_timeout_ = 0.0;
  sqlite3* handle_ = nullptr;
};

/// One statement: bind the values in order, then step through the rows.
class SqliteStatement {
 public:
  /// Keeps a reference to the database.
  SqliteStatement(const SqliteDatabase& database, const std::string& sql);
  ~SqliteStatement();
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  void bind(const std::string& text);
  void bind(const std::optional<double>& number);
  void bind_bytes(const std::string& bytes);
  void bind_null();

  bool step();  // true when there is a row to read
  bool is_null(int column);
  int integer(int column);
  double number(int column);
  std::string bytes(int column);  // of text and of blobs

 private:
  const SqliteDatabase& database_;
  sqlite3_stmt* handle_ = nullptr;
  int bound_ = 0;
};

}  // namespace meniscus::store
