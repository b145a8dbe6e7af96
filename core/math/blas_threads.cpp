#include "core/math/blas_threads.h"

#include <cblas.h>
#include <cstddef>
#include <mutex>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/memory.h"

namespace meniscus {

namespace {

/// BLAS sums change with its number of threads, so it runs on one. Told once:
/// telling it writes to variables that other threads' BLAS reads.
void use_one_blas_thread() {
  static std::once_flag told;
  std::call_once(told, [] { openblas_set_num_threads(1); });
}

/// OpenBLAS asks for its buffer again and again where a limit of address space
/// refuses it, without end. Each thread takes its own at its first system; they
/// are kept.
void require_blas_buffer() {
  static thread_local bool taken = false;
  if (taken) {
    return;
  }
  constexpr std::size_t kBuffer = std::size_t{130} << 20;  // of 0.3.21: 128
  if (!has_address_space(kBuffer)) {
    throw SolverError(fmt::format(
        "the limit of address space (ulimit -v) leaves no {} MB for the "
        "buffers of linear algebra; raise it",
        kBuffer >> 20));
  }
  // Large enough that OpenBLAS uses its buffer.
  constexpr int kSize = 64;
  std::vector<double> square(static_cast<std::size_t>(kSize) * kSize, 1.0);
  std::vector<double> product(square.size());
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, kSize, kSize, kSize,
              1.0, square.data(), kSize, square.data(), kSize, 0.0,
              product.data(), kSize);
  taken = true;
}

}  // namespace

void prepare_blas() {
  use_one_blas_thread();
  require_blas_buffer();
}

}  // namespace meniscus
