/// What a running stage tells its caller, and how the caller stops it.
/// Libraries never print; the application draws.
#pragma once

#include <string>

namespace meniscus {

enum class Severity { Debug, Info, Warning, Error };

struct Progress {
  std::string stage;       // "film", "mesh", "fea", ...
  std::string detail;      // one short line for people
  double fraction = -1.0;  // done so far, 0..1; negative: not known
};

class Monitor {
 public:
  virtual ~Monitor() = default;
  virtual void log(Severity /*severity*/, const std::string& /*message*/) {}
  virtual void progress(const Progress& /*progress*/) {}
  /// Asked between the steps of every iteration; must be cheap.
  virtual bool stop_requested() const { return false; }
};

/// A monitor that hears nothing and never stops; shared, stateless.
Monitor& silent_monitor();

/// Throws Interrupted, naming the stage, when the monitor asks to stop.
void throw_if_stopped(const Monitor& monitor, const char* stage);

}  // namespace meniscus
