/// Ctrl-C and its relatives ask the program to stop; a second one ends it.
#pragma once

namespace meniscus::app {

/// From now on SIGINT, SIGTERM and SIGHUP set a flag that stop_signal() shows,
/// and the second of them ends the process at once with exit code 130. They
/// are blocked and received by a thread of their own, so that no library's
/// handler meets them (METIS takes SIGTERM for an error of its own). A
/// signal that was ignored before (nohup) stays ignored. SIGXFSZ is ignored:
/// a file too large for its limit becomes an error of writing like a full
/// disk, not a sudden end. Where nobody asks stop_signal() for 5 s after the
/// first, or the process still runs a minute after somebody did, it ends too.
void catch_stop_signals();

/// The first stop signal received (SIGINT, ...), 0 as long as there is none.
int stop_signal() noexcept;

/// "Ctrl-C", "SIGTERM", "SIGHUP".
const char* name_of_signal(int signal) noexcept;

}  // namespace meniscus::app
