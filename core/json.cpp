#include "core/json.h"

#include <nlohmann/json.hpp>

namespace meniscus {

nlohmann::ordered_json parse_json(const std::string& text) {
  return nlohmann::ordered_json::parse(text, nullptr, false);
}

nlohmann::ordered_json require_json(const std::string& text) {
  return nlohmann::ordered_json::parse(text);
}

std::string json_text(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent);
}

std::string json_line(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false,
                   nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace meniscus
