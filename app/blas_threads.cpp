// OpenBLAS starts its threads while it is loaded, before main(), and where a
// limit of address space refuses their buffers it asks for them again and
// again. This program computes on threads of its own and lets BLAS use one
// (core/math/linear_solve.cpp), so it has none started.

extern "C" {
/// OpenBLAS's own: threads to start and threads in use, 0 until it has counted
/// processors.
[[gnu::weak]] extern int blas_cpu_number;
[[gnu::weak]] extern int blas_num_threads;
}

namespace {

void start_no_blas_threads() {
  if (&blas_cpu_number != nullptr && &blas_num_threads != nullptr) {
    blas_cpu_number = 1;
    blas_num_threads = 1;
  }
}

/// Runs before the libraries' own beginnings.
[[gnu::section(".preinit_array"),
  gnu::used]] void (*const before_libraries)() = start_no_blas_threads;

}  // namespace
