/// Internal to the language: the texts of printf, small letters.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace meniscus::datafile {

/// `format` as printf would say it, escapes included; conversions d i f F e E
/// g G with flags, width and precision. Nothing when a conversion is another
/// one, or there are more of them than values.
std::optional<std::string> fe_formatted(const std::string& format,
                                        const std::vector<double>& values);

/// In small letters, A to Z alone.
std::string lower(std::string text);

}  // namespace meniscus::datafile
