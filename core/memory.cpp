#include "core/memory.h"

#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace meniscus {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kTopPad = 64 << 20;   // [byte] asked for at a time
  constexpr int kMostFree = 1 << 30;  // [byte] kept at the top of the heap
  mallopt(M_MMAP_MAX, 0);             // large arrays too, from the heap
  mallopt(M_TOP_PAD, kTopPad);
  mallopt(M_TRIM_THRESHOLD, kMostFree);
#endif
}

}  // namespace meniscus
