/// Pictures of films and parts as PNG files.
///
/// VTK ends its process where there is no display, so a helper program
/// (meniscus-render) draws, on a private display (private_display.h): the same
/// picture on every machine, with no window. Whatever goes wrong is a warning:
/// a run without pictures is still a run.
#pragma once

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "report/picture/picture_job.h"

namespace meniscus::picture {

struct PictureOptions {
  double time_limit = 60.0;    // of all jobs together [s], wall clock
  Monitor* monitor = nullptr;  // may be asked by another thread
};

/// Draws one list of jobs after another, by what the caller's own work leaves
/// of the processor. Helper and display start with the first and stay for the
/// next, which then are drawn in half the time; they end with this. For any
/// number of threads.
class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws the jobs in order, behind those begun before; what is wrong with
  /// one does not stop the next. Returns a warning for what failed, with the
  /// reason and what to install or change, and nothing when all pictures are
  /// there. Never throws for the machine's faults; Interrupted when the monitor
  /// asks to stop. The time limit counts from their own beginning.
  std::vector<std::string> render(std::vector<PictureJob> jobs,
                                  const PictureOptions& options = {});

  /// The same, later. The Renderer's end gives up what is not drawn by then.
  std::future<std::vector<std::string>> begin(std::vector<PictureJob> jobs,
                                              const PictureOptions& options);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Is a warning one of those that render() returns?
bool is_about_pictures(const std::string& warning);

/// By a Renderer of its own.
std::vector<std::string> render_pictures(std::vector<PictureJob> jobs,
                                         const PictureOptions& options = {});

/// Pictures drawn while the caller computes on. The destructor ends what is not
/// drawn by then.
class PicturesBeside {
 public:
  /// The time limit is this class's own. `renderer` must outlive it.
  PicturesBeside(Renderer& renderer, std::vector<PictureJob> jobs,
                 Monitor* monitor);
  ~PicturesBeside();
  PicturesBeside(const PicturesBeside&) = delete;
  PicturesBeside& operator=(const PicturesBeside&) = delete;

  /// Until all are drawn: what Renderer::render() returns or throws.
  std::vector<std::string> wait();

 private:
  struct StopMonitor;
  std::unique_ptr<StopMonitor> monitor_;
  std::future<std::vector<std::string>> warnings_;
};

}  // namespace meniscus::picture
