/// Counts and quantities in messages.
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

/// "12.3 mm" with `digits` significant digits; the number alone without a unit.
inline std::string quantity_text(double value, const std::string& unit,
                                 int digits = 6) {
  const std::string number = fmt::format("{:.{}g}", value, digits);
  return unit.empty() ? number : number + " " + unit;
}

}  // namespace meniscus
