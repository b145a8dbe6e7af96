/// How this process gets its memory, and how much it can get.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace meniscus {

/// Keeps freed memory for the next arrays instead of giving it back page by
/// page: stages allocate and free the same large arrays again and again, and
/// clearing new pages is up to a fifth of a film's time. For programs, at
/// their start; a library leaves the choice to the program. No effect where
/// the C library is not glibc.
void keep_freed_memory();

/// Starts the threads that OpenMP will use now where address space is limited
/// (ulimit -v): later, among arrays, there may be no room for their stacks, and
/// libgomp then ends the process. For programs, at their start. Throws
/// SolverError where there is no room now.
void start_threads();

/// Whether so many bytes of address space can be mapped now, in one piece.
bool has_address_space(std::size_t bytes);

/// Bytes that this process can still get: what the machine and the process's
/// control groups have left, at most its own limit of address space. Infinite
/// where the system does not tell.
double available_memory();

/// What the control groups of a process have left (cgroups(7), both versions):
/// its own and those around it, with the pages of files that they can drop.
/// `list`: their names; `mount`: where their files are. In a container a name
/// may be the host's: what cannot be read is skipped. Infinite without a limit.
double group_memory(const std::filesystem::path& list = "/proc/self/cgroup",
                    const std::filesystem::path& mount = "/sys/fs/cgroup");

/// Throws SolverError when `bytes` are more than available_memory(): "`what`
/// needs about 5.2 GB of memory, 3.1 GB are free; `advice`". Up to 30 MB are
/// not looked at. Linux hands out
/// more than it has and kills who then uses it: nothing else would be said.
void require_memory(double bytes, const std::string& what,
                    const std::string& advice);

}  // namespace meniscus
