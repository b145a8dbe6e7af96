#include "pipeline/reader/case_reader_overrides.h"

#include <algorithm>
#include <charconv>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/math/expression.h"
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

/// Where a value is put: below a key, or in the nested arrays there.
struct Slot {
  toml::table* parent = nullptr;
  std::string key;
  std::vector<std::size_t> element = {};  // its place in each array, from 0

  auto operator<=>(const Slot&) const = default;
};

/// Is it a key of one of the vocabulary's tables that have no entries by name?
bool is_key_of_table(const std::string& table, const std::string& key) {
  return std::any_of(
      case_tables().begin(), case_tables().end(), [&](const TableSpec& spec) {
        return spec.name == table && !spec.named_entries &&
               !is_entry_table(table) && find_key(spec, key) != nullptr;
      });
}

/// Where the value goes; no parent when there is no such place. Begins a table
/// that the file leaves out, [analysis] say.
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
    const bool of_head = find_key(case_table(""), name) != nullptr;
    return {of_head ? &root : nullptr, name};
  }
  if (parts.size() == 2 && !root.contains(parts[0]) &&
      is_key_of_table(parts[0], parts[1])) {
    root.insert(parts[0], toml::table{});
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

/// An element of a vector, "t[2, 3]": the vector's table, its shape and the
/// element's indices from 1.
struct Element {
  toml::table* table = nullptr;
  std::vector<int> shape;
  std::vector<int> indices;
};

/// Whole numbers between commas and blanks; none where there is anything else.
std::vector<int> indices_in(std::string_view text) {
  std::vector<int> indices;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const std::string part(
        trimmed(std::string(text.substr(from, comma - from))));
    int index = 0;
    const char* end = part.data() + part.size();
    const auto read = std::from_chars(part.data(), end, index);
    if (read.ec != std::errc() || read.ptr != end) {
      return {};
    }
    indices.push_back(index);
    from = comma + 1;
  }
  return indices;
}

std::vector<int> shape_in(const toml::table& design) {
  const toml::node* node = design.get("shape");
  const toml::array* array = node == nullptr ? nullptr : node->as_array();
  std::vector<int> shape;
  if (array == nullptr && node != nullptr) {
    shape.push_back(node->value_or(0));
  }
  for (std::size_t k = 0; array != nullptr && k < array->size(); ++k) {
    shape.push_back((*array)[k].value_or(0));
  }
  return shape;
}

/// No table where the name, which has a '[', is of no vector of the case.
Element find_element(toml::table& root, const std::string& name) {
  const std::size_t open = name.find('[');
  const std::size_t close = name.find(']');
  Element found;
  if (close != std::string::npos && close + 1 == name.size()) {
    found.table = root["design"][trimmed(name.substr(0, open))].as_table();
    found.indices = indices_in(name.substr(open + 1, close - open - 1));
  }
  if (found.table != nullptr) {
    found.shape = shape_in(*found.table);
  }
  return found;
}

/// What is wrong with the indices; empty for an element that is there.
std::string wrong_indices(const Element& element) {
  bool good = element.indices.size() == element.shape.size();
  double elements = 1.0;
  for (std::size_t k = 0; good && k < element.shape.size(); ++k) {
    good = element.indices[k] >= 1 && element.indices[k] <= element.shape[k];
    elements *= element.shape[k];
  }
  if (good && elements > kMostElements) {
    return fmt::format("its shape {} has more than {}",
                       shape_text(element.shape), kMostElements);
  }
  return good ? ""
         : element.shape.empty()
             ? "it has no shape and is one value"
             : fmt::format("its shape is {}, counted from 1",
                           shape_text(element.shape));
}

toml::array copies_of(const toml::node& value, std::span<const int> shape) {
  toml::array result;
  for (int k = 0; k < shape.front(); ++k) {
    if (shape.size() > 1) {
      result.push_back(copies_of(value, shape.subspan(1)));
    } else {
      result.push_back(value);
    }
  }
  return result;
}

/// Where one value stood for all elements, nested arrays of it.
void spread(toml::table& design, const std::string& key,
            const std::vector<int>& shape) {
  if (const toml::node* value = design.get(key); !value->is_array()) {
    toml::array all = copies_of(*value, shape);
    design.insert_or_assign(key, std::move(all));
  } else if (key == "bounds") {
    toml::array& pair = *design.get(key)->as_array();
    for (std::size_t k = 0; k < pair.size(); ++k) {
      if (!pair[k].is_array()) {
        toml::array all = copies_of(pair[k], shape);
        pair.replace(pair.cbegin() + static_cast<std::ptrdiff_t>(k),
                     std::move(all));
      }
    }
  }
}

/// The array that holds the slot's element; null where the nesting is another.
toml::array* array_of(const Slot& slot) {
  toml::node* node = slot.parent->get(slot.key);
  for (std::size_t level = 0; node != nullptr; ++level) {
    toml::array* array = node->as_array();
    if (array == nullptr || slot.element[level] >= array->size()) {
      return nullptr;
    }
    if (level + 1 == slot.element.size()) {
      return array;
    }
    node = array->get(slot.element[level]);
  }
  return nullptr;
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

/// Puts the value, or for bounds the pair of them, at the element, and notes
/// where.
void put_element(const Element& element, const std::string& key,
                 const toml::node& value, int number,
                 case_data::CaseProblems& problems, std::map<Slot, int>& put) {
  std::vector<std::size_t> at;
  for (const int index : element.indices) {
    at.push_back(static_cast<std::size_t>(index) - 1);
  }
  std::vector<std::pair<Slot, const toml::node*>> slots;
  if (key == "bounds") {
    const toml::array* pair = value.as_array();
    if (pair == nullptr || pair->size() != 2) {
      problems.add(-number, "expected two numbers: [least, largest]");
      return;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<std::size_t> place = at;
      place.insert(place.begin(), k);
      slots.emplace_back(Slot{element.table, key, place}, pair->get(k));
    }
  } else {
    slots.emplace_back(Slot{element.table, key, at}, &value);
  }
  spread(*element.table, key, element.shape);
  for (const auto& [slot, node] : slots) {
    toml::array* array = array_of(slot);
    if (array == nullptr) {
      problems.add(-number, fmt::format("{} is no nested arrays of shape {}",
                                        key, shape_text(element.shape)));
      return;
    }
    compare_dimensions(array->get(slot.element.back()), node, number, problems);
    array->replace(
        array->cbegin() + static_cast<std::ptrdiff_t>(slot.element.back()),
        *node);
    put[slot] = number;
  }
}

/// A name with an index: "t[2, 3]", "design.t[2, 3].bounds".
void override_element(toml::table& root, const std::string& name,
                      const toml::node& value, int number,
                      case_data::CaseProblems& problems,
                      std::map<Slot, int>& put) {
  const std::vector<std::string> parts = split_key(name);
  const bool dotted = parts.size() == 3 && parts[0] == "design" &&
                      (parts[2] == "initial" || parts[2] == "bounds");
  const std::string key = dotted ? parts[2] : "initial";
  Element element;
  if (dotted || parts.size() == 1) {
    element = find_element(root, dotted ? parts[1] : name);
  }
  if (element.table == nullptr || !element.table->contains(key)) {
    problems.add(-number,
                 fmt::format("there is no vector of design variables that has "
                             "'{}'; expected NAME[1, 2] or "
                             "design.NAME[1, 2].bounds",
                             name));
    return;
  }
  if (const std::string wrong = wrong_indices(element); !wrong.empty()) {
    problems.add(-number,
                 fmt::format("there is no element '{}': {}", name, wrong));
    return;
  }
  put_element(element, key, value, number, problems, put);
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
  std::map<Slot, int> put;  // a key before the elements below it
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
    if (name.find('[') != std::string::npos) {
      const toml::table value = parse_value(trimmed(text.substr(equals + 1)));
      override_element(root, name, *value.get("value"), number, problems, put);
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
    std::erase_if(put, [&](const auto& before) {
      return before.first.parent == slot.parent && before.first.key == slot.key;
    });
    put[slot] = number;
  }
  OverriddenNodes overridden;
  for (const auto& [slot, number] : put) {
    const toml::array* array = slot.element.empty() ? nullptr : array_of(slot);
    const toml::node* node = array != nullptr ? array->get(slot.element.back())
                                              : slot.parent->get(slot.key);
    if (node != nullptr) {
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
