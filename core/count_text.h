/// Counts in messages.
#pragma once

#include <cstddef>
#include <string>

#include <fmt/format.h>

namespace meniscus {

/// "1 film", "3 films"; `many` where it is not `one` with an s ("bodies").
inline std::string count_text(std::size_t count, const std::string& one,
                              const std::string& many = "") {
  return fmt::format("{} {}", count,
                     count == 1     ? one
                     : many.empty() ? one + "s"
                                    : many);
}

}  // namespace meniscus
