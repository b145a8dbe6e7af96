#include "pipeline/files/named_values.h"

#include <charconv>

#include <nlohmann/json.hpp>

namespace meniscus::files {

namespace {

using Json = nlohmann::ordered_json;

/// "t" and 1, 0 of "t[2,1]"; no places for a name of its own.
struct Parts {
  std::string name;
  std::vector<std::size_t> places;  // from 0
};

Parts parts_of(const std::string& name) {
  const std::size_t open = name.find('[');
  Parts parts{.name = name.substr(0, open), .places = {}};
  const char* end = name.data() + name.size();
  for (const char* at = name.data() + std::min(open, name.size());
       at < end && *at != ']';) {
    std::size_t index = 0;
    const auto read = std::from_chars(at + 1, end, index);
    if (read.ec != std::errc() || index < 1) {
      return {.name = name, .places = {}};
    }
    parts.places.push_back(index - 1);
    at = read.ptr;
  }
  return parts;
}

}  // namespace

nlohmann::ordered_json named_json(const std::vector<std::string>& names,
                                  const VectorX& values) {
  Json json = Json::object();
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    const Parts parts = parts_of(names[static_cast<std::size_t>(k)]);
    Json* at = &json[parts.name];
    for (const std::size_t place : parts.places) {
      while (at->size() <= place) {
        at->push_back(nullptr);
      }
      at = &(*at)[place];
    }
    *at = values[k];
  }
  return json;
}

const nlohmann::ordered_json* find_named(const nlohmann::ordered_json& json,
                                         const std::string& name) {
  const Parts parts = parts_of(name);
  if (!json.is_object() || !json.contains(parts.name)) {
    return nullptr;
  }
  const Json* at = &json[parts.name];
  for (const std::size_t place : parts.places) {
    if (!at->is_array() || place >= at->size()) {
      return nullptr;
    }
    at = &(*at)[place];
  }
  return at;
}

}  // namespace meniscus::files
