// Debian's Ceres, built for plain x86-64, allocates Eigen's arrays by malloc;
// ours with AVX are aligned by hand (decision 0004). Both are inline functions
// of one name, and a program has one of each. This library stands before Ceres
// on every command line and asks for these symbols (CMakeLists.txt), so ours
// are found.
#include <cstddef>

#include <Eigen/Core>

namespace meniscus::optimize {

namespace {

// An address is what makes the compiler keep an inline function as a symbol.
[[gnu::used]] void* (*const kMalloc)(std::size_t) =
    &Eigen::internal::aligned_malloc;
[[gnu::used]] void* (*const kRealloc)(void*, std::size_t, std::size_t) =
    &Eigen::internal::aligned_realloc;
[[gnu::used]] void (*const kFree)(void*) = &Eigen::internal::aligned_free;

}  // namespace

}  // namespace meniscus::optimize
