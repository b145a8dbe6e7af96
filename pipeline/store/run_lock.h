/// One run at a time in a results folder.
#pragma once

#include <optional>
#include <string>

namespace meniscus::store {

/// Holds FOLDER/.lock as a POSIX record lock: the kernel gives it back when
/// the process ends, however it ends, and a child process does not inherit it
/// (an orphaned mesher would otherwise keep the folder locked). The file stays
/// and names the last holder. Nothing else in the process may open it.
class RunLock {
 public:
  /// Creates the folder when it is missing. Throws InvalidInput, naming the
  /// holder's process and host, when another run has the folder; IoError when
  /// the folder cannot be used.
  explicit RunLock(const std::string& folder);
  ~RunLock();
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&& other) noexcept;
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

 private:
  void release() noexcept;

  std::string path_;  // canonical; empty: holds nothing
  int file_ = -1;
};

/// Who holds the folder, "process 12 on host"; none when no run is at work in
/// it. Takes nothing and creates nothing.
std::optional<std::string> holder_of_run(const std::string& folder);

}  // namespace meniscus::store
