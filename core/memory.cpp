#include "core/memory.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <omp.h>
#include <unistd.h>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include "core/error.h"

namespace meniscus {

namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// The first number in a file; unlimited when there is none ("max").
double number_in(const std::string& path) {
  double value = 0.0;
  return std::ifstream(path) >> value ? value : kUnlimited;
}

double machine_has() {
  std::ifstream file("/proc/meminfo");
  std::string name;
  double kib = 0.0;
  std::string rest;
  while (file >> name >> kib && std::getline(file, rest)) {
    if (name == "MemAvailable:") {
      return 1024.0 * kib;
    }
  }
  return kUnlimited;
}

double group_has() {
  const std::string folder = "/sys/fs/cgroup/";
  const double now = number_in(folder + "memory.current");
  const double before = number_in(folder + "memory/memory.usage_in_bytes");
  return std::min(
      now < kUnlimited ? number_in(folder + "memory.max") - now : kUnlimited,
      before < kUnlimited
          ? number_in(folder + "memory/memory.limit_in_bytes") - before
          : kUnlimited);
}

double process_has() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
    return kUnlimited;
  }
  const double pages = number_in("/proc/self/statm");
  return static_cast<double>(limit.rlim_cur) -
         (pages < kUnlimited
              ? pages * static_cast<double>(sysconf(_SC_PAGESIZE))
              : 0.0);
}

/// What is free in the heap already.
double heap_has() {
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
  return static_cast<double>(mallinfo2().fordblks);
#else
  return 0.0;
#endif
}

}  // namespace

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kTopPad = 64 << 20;   // [byte] asked for at a time
  constexpr int kMostFree = 1 << 30;  // [byte] kept at the top of the heap
  mallopt(M_MMAP_MAX, 0);             // large arrays too, from the heap
  mallopt(M_TOP_PAD, kTopPad);
  mallopt(M_TRIM_THRESHOLD, kMostFree);
#endif
}

bool has_address_space(std::size_t bytes) {
  void* room = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return room != MAP_FAILED && ::munmap(room, bytes) == 0;
}

void start_threads() {
  const int others = omp_get_max_threads() - 1;
  rlimit limit{};
  if (others < 1 || getrlimit(RLIMIT_AS, &limit) != 0 ||
      limit.rlim_cur == RLIM_INFINITY) {
    return;
  }
  rlimit stack{};
  constexpr rlim_t kUsualStack = 8 << 20;  // [byte]
  const bool limited =
      getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur != RLIM_INFINITY;
  constexpr rlim_t kBeside = 2 << 20;  // what a thread takes beside its stack
  const auto bytes = static_cast<std::size_t>(others) *
                     ((limited ? stack.rlim_cur : kUsualStack) + kBeside);
  if (!has_address_space(bytes)) {
    throw SolverError(fmt::format(
        "the limit of address space (ulimit -v) leaves no {} MB for {} more "
        "threads; raise it, or give --threads 1",
        bytes >> 20, others));
  }
  int started = 0;
#pragma omp parallel reduction(+ : started)
  started += 1;  // or the compiler leaves the region out
}

double available_memory() {
  return heap_has() +
         std::max(0.0, std::min({machine_has(), group_has(), process_has()}));
}

void require_memory(double bytes, const std::string& what,
                    const std::string& advice) {
  constexpr double kGiga = 1e9;
  constexpr double kSmall = 3e7;  // asking the system would take longer
  if (bytes <= kSmall) {
    return;
  }
  const double free = available_memory();
  if (bytes > free) {
    throw SolverError(fmt::format(
        "{} needs about {:.2g} GB of memory, {:.2g} GB are free; {}", what,
        bytes / kGiga, free / kGiga, advice));
  }
}

}  // namespace meniscus
