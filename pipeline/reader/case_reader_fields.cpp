#include "pipeline/reader/case_reader_fields.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/nearest_name.h"

namespace meniscus::reader {

namespace {

constexpr std::size_t kShown = 40;  // characters of a text in a message

}  // namespace

case_data::SourceLine CaseContext::line_of(const toml::node& node) const {
  const auto at = overridden.find(&node);
  return at != overridden.end() ? -at->second
                                : static_cast<int>(node.source().begin.line);
}

std::string described(const toml::node& node) {
  if (const auto* text = node.as_string()) {
    const std::string& value = text->get();
    return fmt::format("the text '{}{}'", value.substr(0, kShown),
                       value.size() > kShown ? "..." : "");
  }
  if (const auto* array = node.as_array()) {
    return fmt::format("an array of {}", array->size());
  }
  if (node.is_number()) {
    return fmt::format("{:g}", *node.value<double>());
  }
  return node.is_table()     ? "a table"
         : node.is_boolean() ? (*node.value<bool>() ? "true" : "false")
                             : "a date or time";
}

CaseTable::CaseTable(CaseContext& context, const toml::table& table,
                     const TableSpec& spec, std::string name, std::string path)
    : context_(&context),
      table_(&table),
      spec_(&spec),
      name_(std::move(name)),
      path_(std::move(path)) {
  std::vector<std::string> known;
  for (const KeySpec& key : spec.keys) {
    known.emplace_back(key.key);
    if (key.required && !table.contains(key.key)) {
      context.problems.add(line(), fmt::format("{} has no '{}' ({}); add it",
                                               path_, key.key, key.doc));
    }
  }
  for (const auto& [key, node] : table) {
    const std::string found(key.str());
    if (find_key(spec, found) == nullptr) {
      context.problems.add(context.line_of(node),
                           fmt::format("unknown key '{}' in {}{}", found, path_,
                                       case_data::advice(found, known)));
    }
  }
}

case_data::SourceLine CaseTable::line(const char* key) const {
  const toml::node* node = table_->get(key);
  return node == nullptr ? line() : context_->line_of(*node);
}

namespace {

std::string all_of(const case_data::KindKeys& keys) {
  std::vector<std::string> all = keys.needed;
  all.insert(all.end(), keys.optional.begin(), keys.optional.end());
  return all.empty() ? "no keys of its own"
                     : fmt::format("{}", fmt::join(all, ", "));
}

}  // namespace

void CaseTable::check_kind(const std::string& kind,
                           const case_data::KindKeys& keys) const {
  for (const std::string& key : keys.needed) {
    if (!table_->contains(key)) {
      context_->problems.add(
          line(),
          fmt::format("{} is a {} and has no '{}'; add it", path_, kind, key));
    }
  }
  const auto among = [](const std::vector<std::string>& list,
                        const std::string& key) {
    return std::find(list.begin(), list.end(), key) != list.end();
  };
  for (const auto& [node_key, node] : *table_) {
    const std::string key(node_key.str());
    if (key != "kind" && key != "repeat" && find_key(*spec_, key) != nullptr &&
        !among(keys.needed, key) && !among(keys.optional, key)) {
      context_->problems.add(
          context_->line_of(node),
          fmt::format("{}.{} does not belong to a {}; it has {}", path_, key,
                      kind, all_of(keys)));
    }
  }
}

void CaseTable::note(const char* key, const std::string& expected) const {
  context_->problems.add(line(key),
                         fmt::format("{}.{} is {}; expected {}", path_, key,
                                     described(*node(key)), expected));
}

std::optional<Dimension> CaseTable::dimension(const char* key) const {
  return find_key(*spec_, key)->dimension;
}

std::optional<std::string> CaseTable::text(const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  if (const auto* value = node(key)->as_string()) {
    return filled_text(*node(key), value->get(), indices_);
  }
  note(key, "text in quotes");
  return std::nullopt;
}

std::optional<std::string> CaseTable::choice(const char* key) const {
  auto value = text(key);
  if (!value) {
    return value;
  }
  const KeySpec& spec = *find_key(*spec_, key);
  const auto among = [&](const std::string& list) {
    const std::vector<std::string> choices = split_choices(list);
    return std::find(choices.begin(), choices.end(), *value) != choices.end();
  };
  if (among(spec.choices)) {
    return value;
  }
  const std::vector<std::string> choices = split_choices(spec.choices);
  const std::string near = nearest_name(*value, choices);
  const std::string expected =
      near.empty() ? fmt::format("expected one of {}", fmt::join(choices, ", "))
                   : fmt::format("did you mean '{}'?", near);
  if (among(spec.later)) {
    context_->problems.add(
        line(key), fmt::format("{}.{} '{}' is not available in this version; "
                               "expected one of {}",
                               path_, key, *value, fmt::join(choices, ", ")));
  } else {
    context_->problems.add(line(key),
                           fmt::format("{}.{} is {}; {}", path_, key,
                                       described(*node(key)), expected));
  }
  return std::nullopt;
}

std::vector<std::string> CaseTable::name_or_names(const char* key) const {
  if (!has(key)) {
    return {};
  }
  if (node(key)->is_array()) {
    return names(key);
  }
  if (!node(key)->is_string()) {
    note(key, "a name, or a list of names");
    return {};
  }
  return {*text(key)};
}

std::vector<std::string> CaseTable::names_or_numbers(const char* key) const {
  std::vector<std::string> result;
  if (!has(key)) {
    return result;
  }
  const auto add = [&](const toml::node& item) {
    if (const auto* name = item.as_string()) {
      result.push_back(filled_text(item, name->get(), indices_));
    } else if (const auto number = item.value_exact<std::int64_t>()) {
      result.push_back(fmt::format("{}", *number));
    }
  };
  const toml::array* array = node(key)->as_array();
  const std::size_t wanted = array == nullptr ? 1 : array->size();
  if (array == nullptr) {
    add(*node(key));
  } else {
    for (const toml::node& item : *array) {
      add(item);
    }
  }
  if (wanted == 0 || result.size() != wanted) {
    note(key, "a name or a number, or several: 7, \"rim\", [3, 4]");
    result.clear();
  }
  return result;
}

std::optional<bool> CaseTable::flag(const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  if (const auto* value = node(key)->as_boolean()) {
    return value->get();
  }
  note(key, "true or false");
  return std::nullopt;
}

std::optional<int> CaseTable::positive_integer(const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const auto value = node(key)->value_exact<std::int64_t>();
  if (value && *value >= 1 && *value <= std::numeric_limits<int>::max()) {
    return static_cast<int>(*value);
  }
  note(key, "a whole number above 0");
  return std::nullopt;
}

std::optional<int> CaseTable::integer_within(const char* key, int least,
                                             int most) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const auto value = node(key)->value_exact<std::int64_t>();
  if (value && *value >= least && *value <= most) {
    return static_cast<int>(*value);
  }
  note(key, fmt::format("a whole number from {} to {}", least, most));
  return std::nullopt;
}

std::optional<case_data::Quantity> CaseTable::quantity(const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const IndexScope scope(*context_, indices_);
  return read_quantity(*context_, *node(key), dimension(key),
                       fmt::format("{}.{}", path_, key));
}

std::vector<case_data::Quantity> CaseTable::quantities(const char* key) const {
  const toml::array* array = has(key) ? node(key)->as_array() : nullptr;
  std::vector<case_data::Quantity> result;
  if (array == nullptr) {
    if (auto one = quantity(key)) {
      result.push_back(std::move(*one));
    }
    return result;
  }
  const IndexScope scope(*context_, indices_);
  for (std::size_t k = 0; k < array->size(); ++k) {
    if (auto one = read_quantity(*context_, (*array)[k], dimension(key),
                                 fmt::format("{}.{}[{}]", path_, key, k + 1))) {
      result.push_back(std::move(*one));
    }
  }
  return result;
}

std::optional<case_data::PlaceQuantity> CaseTable::place_quantity(
    const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const IndexScope scope(*context_, indices_);
  const KeySpec* spec = find_key(*spec_, key);
  const bool field = spec != nullptr && spec->type == KeyType::Field;
  return read_place_quantity(
      *context_, *node(key), dimension(key), fmt::format("{}.{}", path_, key),
      field ? context_->shapes : std::vector<std::string>());
}

std::optional<Constant> CaseTable::measured(const char* key) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const IndexScope scope(*context_, indices_);
  return read_measured(*context_, *node(key), dimension(key),
                       fmt::format("{}.{}", path_, key));
}

std::optional<double> CaseTable::constant(const char* key) const {
  const std::optional<Constant> found = measured(key);
  return found ? std::optional(found->value) : std::nullopt;
}

std::optional<double> CaseTable::constant(const char* key,
                                          Dimension dimension) const {
  if (!has(key)) {
    return std::nullopt;
  }
  const IndexScope scope(*context_, indices_);
  return read_constant(*context_, *node(key), dimension,
                       fmt::format("{}.{}", path_, key));
}

std::vector<double> CaseTable::constants(const char* key) const {
  std::vector<double> result;
  if (!has(key)) {
    return result;
  }
  const toml::array* array = node(key)->as_array();
  if (array == nullptr || array->empty()) {
    note(key, "numbers: [5.0, 2.0]");
    return result;
  }
  const IndexScope scope(*context_, indices_);
  for (const toml::node& item : *array) {
    if (const auto value = read_constant(*context_, item, dimension(key),
                                         fmt::format("{}.{}", path_, key))) {
      result.push_back(*value);
    }
  }
  if (result.size() != array->size()) {
    result.clear();
  }
  return result;
}

case_data::Quantity CaseTable::quantity_or_zero(const char* key) const {
  return quantity(key).value_or(case_data::Quantity{
      .line = line(key), .key = fmt::format("{}.{}", path_, key)});
}

case_data::QuantityVector CaseTable::vector_or_zero(const char* key) const {
  const case_data::Quantity zero{.line = line(key),
                                 .key = fmt::format("{}.{}", path_, key)};
  return vector(key).value_or(case_data::QuantityVector{zero, zero, zero});
}

}  // namespace meniscus::reader
