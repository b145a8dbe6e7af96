/// Expressions as text, with numbers in the place of names.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace meniscus::case_data {

/// The text with each of `names` replaced by its value, in parentheses and to
/// the last bit; other names and functions stay.
std::string with_values(const std::string& text,
                        const std::vector<std::string>& names,
                        std::span<const double> values);

}  // namespace meniscus::case_data
