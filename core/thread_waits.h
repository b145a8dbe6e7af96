/// How this process's threads wait for each other.
#pragma once

namespace meniscus {

/// Makes OpenMP's threads sleep while they wait, unless OMP_WAIT_POLICY or
/// GOMP_SPINCOUNT says otherwise. By default they spin: with another program
/// on the cores, a thread then burns the time that the one it waits for needs,
/// and two threads take six times as long as one (docs/performance.md). OpenMP
/// reads its settings before `main` begins, so the program starts itself anew,
/// under the same process id. For programs, as the first thing in main; returns
/// where nothing needs to change or the start fails.
void wait_asleep(char** argv);

}  // namespace meniscus
