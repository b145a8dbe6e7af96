#include "pipeline/reader/case_reader_overrides.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace meniscus::reader {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  const std::size_t last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// The value as TOML: number, array or table as they stand, else text.
toml::table parse_value(const std::string& value) {
  if (value.find('\n') == std::string::npos) {
    try {
      return toml::parse(std::string_view("value = " + value + "\n"));
    } catch (const toml::parse_error&) {  // text without quotes
    }
  }
  return toml::table{{"value", value}};
}

/// Every dotted key of the file that holds a value.
void list_keys(const toml::table& table, const std::string& prefix,
               std::vector<std::string>& keys) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    if (path == "study.members") {  // values of their own, not the case's
      continue;
    }
    if (const toml::table* inner = node.as_table()) {
      list_keys(*inner, path + ".", keys);
    } else {
      keys.push_back(path);
    }
  }
}

/// All that can be overridden, by the names that people give.
std::vector<std::string> known_names(const toml::table& root) {
  std::vector<std::string> known;
  list_keys(root, "", known);
  const std::size_t count = known.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::string path = known[k];
    if (path.starts_with("parameters.")) {
      known.push_back(path.substr(11));
    } else if (path.starts_with("design.") && path.ends_with(".initial")) {
      known.push_back(path.substr(7, path.size() - 15));
    }
  }
  return known;
}

std::vector<std::string> split_key(const std::string& key) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t dot = key.find('.'); dot != std::string::npos;
       dot = key.find('.', from)) {
    parts.push_back(key.substr(from, dot - from));
    from = dot + 1;
  }
  parts.push_back(key.substr(from));
  return parts;
}

struct Slot {
  toml::table* parent = nullptr;
  std::string key;
};

/// Where the value goes; no parent when there is no such place.
Slot find_slot(toml::table& root, const std::string& name) {
  std::vector<std::string> parts = split_key(name);
  if (parts.size() == 1) {
    toml::table* parameters = root["parameters"].as_table();
    if (parameters != nullptr && parameters->contains(name)) {
      return {parameters, name};
    }
    if (toml::table* design = root["design"][name].as_table()) {
      return {design, "initial"};
    }
    toml::node* top = root.get(name);
    return {top != nullptr && !top->is_table() ? &root : nullptr, name};
  }
  Slot slot{&root, parts.back()};
  for (std::size_t k = 0; k + 1 < parts.size() && slot.parent != nullptr; ++k) {
    toml::node* next = slot.parent->get(parts[k]);
    slot.parent = next == nullptr ? nullptr : next->as_table();
  }
  // A key that is not in the file may be added to a table that is; the
  // vocabulary's check follows. A new parameter would be a slip.
  if (slot.parent != nullptr && parts[0] == "parameters" &&
      !slot.parent->contains(slot.key)) {
    slot.parent = nullptr;
  }
  return slot;
}

/// What a text with a unit measures; nothing for anything else.
std::optional<UnitPowers> powers_in(const toml::node* node) {
  const auto* text = node == nullptr ? nullptr : node->as_string();
  if (text == nullptr || !looks_like_quantity(text->get())) {
    return std::nullopt;
  }
  try {
    return quantity_powers(text->get());
  } catch (const InvalidInput&) {
    return std::nullopt;  // told where the value is read
  }
}

/// Notes a value of another dimension than that which the file has there.
void compare_dimensions(const toml::node* before, const toml::node* after,
                        int number, case_data::CaseProblems& problems) {
  const auto was = powers_in(before);
  const auto is = powers_in(after);
  if (was && is && !(*was == *is)) {
    problems.add(-number,
                 fmt::format("'{}' is {}; expected {}, as '{}' in the file is",
                             *after->value<std::string>(), described(*is),
                             described(*was), *before->value<std::string>()));
  }
}

void mark(const toml::node& node, int number, OverriddenNodes& overridden) {
  overridden[&node] = number;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& item : *array) {
      mark(item, number, overridden);
    }
  } else if (const toml::table* table = node.as_table()) {
    for (const auto& [key, item] : *table) {
      mark(item, number, overridden);
    }
  }
}

}  // namespace

OverriddenNodes apply_overrides(toml::table& root,
                                const std::vector<std::string>& overrides,
                                case_data::CaseProblems& problems) {
  std::map<std::pair<toml::table*, std::string>, int> put;
  for (std::size_t k = 0; k < overrides.size(); ++k) {
    const std::string& text = overrides[k];
    const int number = static_cast<int>(k) + 1;
    const std::size_t equals = text.find('=');
    const std::string name =
        trimmed(text.substr(0, std::min(equals, text.size())));
    if (equals == std::string::npos || name.empty()) {
      problems.add(-number, "expected name=value");
      continue;
    }
    const Slot slot = find_slot(root, name);
    if (slot.parent == nullptr) {
      problems.add(
          -number,
          fmt::format("there is no parameter, design variable or key "
                      "'{}'{}",
                      name, case_data::advice(name, known_names(root))));
      continue;
    }
    toml::table value = parse_value(trimmed(text.substr(equals + 1)));
    compare_dimensions(slot.parent->get(slot.key), value.get("value"), number,
                       problems);
    slot.parent->insert_or_assign(slot.key, std::move(*value.get("value")));
    put[{slot.parent, slot.key}] = number;
  }
  OverriddenNodes overridden;
  for (const auto& [slot, number] : put) {
    if (const toml::node* node = slot.first->get(slot.second)) {
      mark(*node, number, overridden);
    }
  }
  return overridden;
}

void let_parameters_scatter(toml::table& root, OverriddenNodes& overridden) {
  const auto kind = root["study"]["kind"].value<std::string>();
  const toml::table* deviations = root["study"]["deviations"].as_table();
  toml::table* parameters = root["parameters"].as_table();
  if (kind != "tolerance" || deviations == nullptr || parameters == nullptr) {
    return;
  }
  if (!root.contains("design")) {
    root.insert("design", toml::table{});
  }
  toml::table* design = root["design"].as_table();
  for (const auto& [key, deviation] : *deviations) {
    const toml::node* value = parameters->get(key.str());
    if (value == nullptr || design == nullptr || design->contains(key.str())) {
      continue;
    }
    const auto set = overridden.find(value);
    const int number = set == overridden.end() ? 0 : set->second;
    if (number > 0) {
      overridden.erase(set);
    }
    toml::table variable{{"initial", *value},
                         {"bounds", toml::array{*value, *value}}};
    parameters->erase(key.str());
    const auto at = design->insert_or_assign(key.str(), std::move(variable));
    if (number > 0) {
      mark(at.first->second, number, overridden);
    }
  }
  if (parameters->empty()) {
    root.erase("parameters");
  }
  if (design != nullptr && design->empty()) {
    root.erase("design");
  }
}

}  // namespace meniscus::reader
