/// Expressions as text, with numbers in the place of names.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace meniscus {

/// The text with each of `names` replaced by a text; other names and functions
/// stay.
std::string with_texts(const std::string& text,
                       const std::vector<std::string>& names,
                       const std::vector<std::string>& texts);

/// The text with each of `names` replaced by its value, in parentheses and to
/// the last bit; other names and functions stay. An element of a vector is
/// found as Expression::text() has it, "t[2,3]".
std::string with_values(const std::string& text,
                        const std::vector<std::string>& names,
                        std::span<const double> values);

}  // namespace meniscus
