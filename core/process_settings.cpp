#include "core/process_settings.h"

#include <cstdlib>
#include <unistd.h>

namespace meniscus {

namespace {

bool is_set(const char* name) { return std::getenv(name) != nullptr; }

}  // namespace

void start_with_settings(char** argv) {
  bool changed = false;
  const auto set = [&](const char* name, const char* value) {
    changed = setenv(name, value, 1) == 0 || changed;
  };
  if (!is_set("OMP_WAIT_POLICY") && !is_set("GOMP_SPINCOUNT")) {
    set("OMP_WAIT_POLICY", "passive");
  }
  if (!is_set("GLIBC_TUNABLES")) {
    set("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1");
  }
  if (changed) {
    execv("/proc/self/exe", argv);  // comes back only when it fails
  }
}

}  // namespace meniscus
