/// Points and directions in JSON files.
#pragma once

#include <nlohmann/json.hpp>

#include "core/types.h"

namespace meniscus::files {

/// [x, y, z].
inline nlohmann::ordered_json place_json(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace meniscus::files
