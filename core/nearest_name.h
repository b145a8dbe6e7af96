/// "Did you mean ...?" for names that people type.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace meniscus {

/// The entry of `known` nearest to `name` by edit distance, or empty when none
/// is near (more than a third of the letters differ).
std::string nearest_name(std::string_view name,
                         const std::vector<std::string>& known);

}  // namespace meniscus
