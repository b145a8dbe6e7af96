/// What libraries read from the environment before `main` begins.
#pragma once

namespace meniscus {

/// Gives this process the settings that its libraries take before `main`: the
/// program starts itself anew with them, under the same process id. A setting
/// that the environment has is left alone.
///   OMP_WAIT_POLICY=passive (unless GOMP_SPINCOUNT is there): OpenMP's threads
///     sleep while they wait. By default they spin: with another program on the
///     cores, a thread then burns the time that the one it waits for needs, and
///     two threads take six times as long as one (docs/performance.md).
///   GLIBC_TUNABLES=glibc.malloc.hugetlb=1: large arrays are put into pages of
///     2 MB where the kernel has them, not 512 times as many of 4 kB, which it
///     would clear one by one and the processor look up one by one.
/// For programs, as the first thing in main; returns where nothing needs to
/// change or the start fails.
void start_with_settings(char** argv);

}  // namespace meniscus
