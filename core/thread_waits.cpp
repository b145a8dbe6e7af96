#include "core/thread_waits.h"

#include <cstdlib>
#include <unistd.h>

namespace meniscus {

void wait_asleep(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr ||
      std::getenv("GOMP_SPINCOUNT") != nullptr) {
    return;
  }
  if (setenv("OMP_WAIT_POLICY", "passive", 1) == 0) {
    execv("/proc/self/exe", argv);  // comes back only when it fails
  }
}

}  // namespace meniscus
