/// A loop in threads whose steps may throw.
#pragma once

#include <cstddef>
#include <exception>
#include <vector>

namespace meniscus {

/// each(k) for k from 0 to count - 1, in any order. Of what is thrown, that of
/// the lowest k is thrown on, whatever the threads.
template <class Each>
void parallel_for(std::ptrdiff_t count, const Each& each) {
  std::exception_ptr thrown;
  std::ptrdiff_t first = count;
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    try {
      each(k);
    } catch (...) {
#pragma omp critical(meniscus_parallel_for)
      if (k < first) {
        first = k;
        thrown = std::current_exception();
      }
    }
  }
  if (thrown) {
    std::rethrow_exception(thrown);
  }
}

}  // namespace meniscus
