/// Design variables by name in JSON: a vector's elements are nested arrays
/// under its one name.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/types.h"

namespace meniscus::files {

/// {"foot": 25.0, "t": [[1.0, 2.0], [3.0, 4.0]]} of values by the names of
/// design variables, as many as there are values; elements, "t[2,1]", in their
/// order, the last index running fastest.
nlohmann::ordered_json named_json(const std::vector<std::string>& names,
                                  const VectorX& values);

/// What such an object has for "foot" or "t[2,1]"; null where nothing stands.
const nlohmann::ordered_json* find_named(const nlohmann::ordered_json& json,
                                         const std::string& name);

}  // namespace meniscus::files
