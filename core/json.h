/// The one compiled door to nlohmann's reader and writer of JSON texts: each
/// source that names them compiles them anew.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace meniscus {

/// The value that `text` says, keys in its order; is_discarded() where it is no
/// JSON.
nlohmann::ordered_json parse_json(const std::string& text);

/// The same. Throws nlohmann's parse_error where it is no JSON.
nlohmann::ordered_json require_json(const std::string& text);

/// Over several lines, deeper ones set in by `indent` blanks; on one line where
/// `indent` is below 0. Throws nlohmann's type_error for what is not UTF-8.
std::string json_text(const nlohmann::ordered_json& json, int indent);

/// On one line; what is not UTF-8 becomes U+FFFD.
std::string json_line(const nlohmann::ordered_json& json);

}  // namespace meniscus
