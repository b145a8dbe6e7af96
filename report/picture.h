/// Pictures of films and parts as PNG files.
///
/// VTK ends its process where there is no display, so a helper program
/// (meniscus-render) draws, on a private virtual display (Xvfb) that this
/// starts and ends: the same picture on every machine, with no window.
/// Without Xvfb the user's own DISPLAY serves. Whatever goes wrong is a
/// warning: a run without pictures is still a run.
#pragma once

#include <string>
#include <vector>

#include "core/monitor.h"
#include "report/picture_job.h"

namespace meniscus {

struct PictureOptions {
  double time_limit = 60.0;  // of all jobs together [s], wall clock
  Monitor* monitor = nullptr;
};

/// Draws the jobs in order; what is wrong with one does not stop the next.
/// Returns a warning for what failed, with the reason and what to install or
/// change, and nothing when all pictures are there. Never throws for the
/// machine's faults; Interrupted when the monitor asks to stop.
std::vector<std::string> render_pictures(const std::vector<PictureJob>& jobs,
                                         const PictureOptions& options = {});

}  // namespace meniscus
