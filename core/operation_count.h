/// How much floating-point work is done: kernels add what their formula says
/// (docs/theory.md, Counting work), once a call, so counting costs nothing.
#pragma once

namespace meniscus {

/// Additions and multiplications, each counted as one; a division or a root as
/// one too. Adds to the calling thread's account: threads that a kernel starts
/// within itself are part of its call.
void count_operations(double operations) noexcept;

/// Of the calling thread, since it began.
double operations_done() noexcept;

}  // namespace meniscus
