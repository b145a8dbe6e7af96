#include "core/operation_count.h"

namespace meniscus {

namespace {

thread_local double account = 0.0;

}  // namespace

void count_operations(double operations) noexcept { account += operations; }

double operations_done() noexcept { return account; }

}  // namespace meniscus
