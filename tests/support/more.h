/// Tests of many draws or the finest meshes: a part of them always, all where
/// MENISCUS_MORE is 1, as for the tests more.NAME, labelled long.
#pragma once

#include <cstdlib>
#include <string_view>

namespace meniscus {

/// `all` where all is asked for, `quick` otherwise.
template <typename T>
T more_or(T all, T quick) {
  const char* value = std::getenv("MENISCUS_MORE");
  return value != nullptr && std::string_view(value) == "1" ? all : quick;
}

}  // namespace meniscus
