/// Pictures of films and parts as PNG files.
///
/// VTK ends its process where there is no display, so a helper program
/// (meniscus-render) draws, on a private virtual display (Xvfb) that this
/// starts and ends, and that opens to its own key only: the same picture on
/// every machine, with no window.
/// Without Xvfb the user's own DISPLAY serves. Whatever goes wrong is a
/// warning: a run without pictures is still a run.
#pragma once

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "report/picture/picture_job.h"

namespace meniscus::picture {

struct PictureOptions {
  double time_limit = 60.0;  // of all jobs together [s], wall clock
  int niceness = 0;          // of the helper, as in ChildOptions
  Monitor* monitor = nullptr;
};

/// Draws the jobs in order; what is wrong with one does not stop the next.
/// Returns a warning for what failed, with the reason and what to install or
/// change, and nothing when all pictures are there. Never throws for the
/// machine's faults; Interrupted when the monitor asks to stop.
std::vector<std::string> render_pictures(const std::vector<PictureJob>& jobs,
                                         const PictureOptions& options = {});

/// Pictures drawn while the caller computes on, by what its work leaves of the
/// processor. The destructor ends what is not drawn by then.
class PicturesBeside {
 public:
  /// The monitor of `options` is asked for a stop by another thread; the time
  /// limit and the niceness are this class's own.
  PicturesBeside(std::vector<PictureJob> jobs, const PictureOptions& options);
  ~PicturesBeside();
  PicturesBeside(const PicturesBeside&) = delete;
  PicturesBeside& operator=(const PicturesBeside&) = delete;

  /// Until all are drawn: what render_pictures() returns or throws.
  std::vector<std::string> wait();

 private:
  struct StopMonitor;
  std::unique_ptr<StopMonitor> monitor_;
  std::future<std::vector<std::string>> warnings_;
};

}  // namespace meniscus::picture
