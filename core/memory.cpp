#include "core/memory.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
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
double number_in(const std::filesystem::path& path) {
  double value = 0.0;
  return std::ifstream(path) >> value ? value : kUnlimited;
}

/// Of a file with a name and a number in each line.
std::optional<double> number_of(const std::filesystem::path& path,
                                const std::string& name) {
  std::ifstream file(path);
  std::string word;
  double value = 0.0;
  std::string unit;
  while (file >> word >> value && std::getline(file, unit)) {
    if (word == name) {
      return value;
    }
  }
  return std::nullopt;
}

double machine_has() {
  return 1024.0 *
         number_of("/proc/meminfo", "MemAvailable:").value_or(kUnlimited);
}

/// Of a control group's files (cgroups(7)), in one of its two versions.
struct GroupFiles {
  const char* limit;
  const char* used;
  const char* stat_prefix;
};

constexpr GroupFiles kFirst = {"memory.limit_in_bytes", "memory.usage_in_bytes",
                               "total_"};
constexpr GroupFiles kSecond = {"memory.max", "memory.current", ""};

/// What the group in `folder` has left, pages of files that it can drop
/// included.
double folder_has(const std::filesystem::path& folder,
                  const GroupFiles& files) {
  const double limit = number_in(folder / files.limit);
  const double used = number_in(folder / files.used);
  if (limit == kUnlimited || used == kUnlimited) {
    return kUnlimited;
  }
  const std::string prefix = files.stat_prefix;
  return limit - used +
         number_of(folder / "memory.stat", prefix + "inactive_file")
             .value_or(0.0) +
         number_of(folder / "memory.stat", prefix + "active_file")
             .value_or(0.0);
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

double group_memory(const std::filesystem::path& list,
                    const std::filesystem::path& mount) {
  std::ifstream groups(list);  // NUMBER:CONTROLLERS:PATH
  double has = kUnlimited;
  for (std::string line; std::getline(groups, line);) {
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (second == std::string::npos) {
      continue;
    }
    const std::string controllers =
        ',' + line.substr(first + 1, second - first - 1) + ',';
    const bool second_version = controllers == ",,";
    if (!second_version && controllers.find(",memory,") == std::string::npos) {
      continue;
    }
    const std::filesystem::path root =
        second_version ? mount : mount / "memory";
    std::filesystem::path group =
        std::filesystem::path(line.substr(second + 1)).lexically_normal();
    while (true) {
      has = std::min(has, folder_has(root / group.relative_path(),
                                     second_version ? kSecond : kFirst));
      if (!group.has_relative_path()) {
        break;
      }
      group = group.parent_path();
    }
  }
  return has;
}

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kTopPad = 64 << 20;   // [byte] asked for at a time
  constexpr int kMostFree = 1 << 30;  // [byte] kept at the top of the heap
  // Larger arrays have pages of their own, given back at once: among them the
  // heap would keep holes of gigabytes. glibc takes no more than this.
  constexpr int kOwnPages = 32 << 20;  // [byte]
  mallopt(M_MMAP_THRESHOLD, kOwnPages);
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
  return heap_has() + std::max(0.0, std::min({machine_has(), group_memory(),
                                              process_has()}));
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
