/// Tables and lists with `repeat`: typed access to each copy.
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/reader/case_reader_repeat.h"

namespace meniscus::reader {

std::string CaseTable::filled_text(const toml::node& node,
                                   const std::string& text,
                                   const std::vector<int>& indices) const {
  return filled(*context_, text, indices, context_->line_of(node), path_);
}

std::vector<CaseTable> CaseTable::copies() const {
  if (!has("repeat")) {
    return {*this};
  }
  const std::string path = path_ + ".repeat";
  const toml::node& node = *table_->get("repeat");
  const std::vector<int> counts = read_counts(*context_, node, path);
  if (counts.empty()) {
    return {};
  }
  std::vector<CaseTable> result;
  for (const std::vector<int>& indices :
       copies_of(*context_, node, path, counts, indices_)) {
    CaseTable copy = *this;
    copy.indices_ = indices;
    const std::string tail = fmt::format("_{}", fmt::join(indices, "_"));
    copy.name_ += name_.empty() ? "" : tail;
    copy.path_ += tail;
    result.push_back(std::move(copy));
  }
  return result;
}

std::vector<std::vector<int>> CaseTable::copies_in(
    const char* key, const toml::table& entry) const {
  const toml::node& node = *entry.get("repeat");
  const std::string path = fmt::format("{}.{}: repeat", path_, key);
  const std::vector<int> counts = read_counts(*context_, node, path);
  return counts.empty() ? std::vector<std::vector<int>>()
                        : copies_of(*context_, node, path, counts, indices_);
}

bool CaseTable::add_names(const char* key, const toml::node& item,
                          std::vector<std::string>& result) const {
  if (const auto* name = item.as_string()) {
    result.push_back(filled_text(item, name->get(), indices_));
    return true;
  }
  const toml::table* entry = item.as_table();
  if (entry == nullptr || entry->size() != 2 || !entry->contains("repeat") ||
      entry->get_as<std::string>("name") == nullptr) {
    return false;
  }
  const std::string name = entry->get_as<std::string>("name")->get();
  for (const std::vector<int>& indices : copies_in(key, *entry)) {
    result.push_back(filled_text(item, name, indices));
  }
  return true;
}

std::vector<std::string> CaseTable::names(const char* key) const {
  std::vector<std::string> result;
  if (!has(key)) {
    return result;
  }
  const toml::array* array = node(key)->as_array();
  bool good = array != nullptr && !array->empty();
  for (std::size_t k = 0; good && k < array->size(); ++k) {
    good = add_names(key, *array->get(k), result);
  }
  if (!good) {
    note(key,
         "names: [\"a\", \"b\"], and { name = \"c_{i}\", repeat = 8 } for "
         "several");
    result.clear();
  }
  return result;
}

std::vector<CaseTable> CaseTable::tables(const char* key,
                                         const char* spec) const {
  std::vector<CaseTable> result;
  if (!has(key)) {
    return result;
  }
  const toml::array* array = node(key)->as_array();
  const bool good =
      array != nullptr && !array->empty() &&
      std::all_of(array->begin(), array->end(),
                  [](const toml::node& n) { return n.is_table(); });
  if (!good) {
    note(key, fmt::format("tables, at least one: [{{ {} = \"...\", ... }}]",
                          case_table(spec).keys.front().key));
    return result;
  }
  for (const toml::node& item : *array) {
    CaseTable entry(*context_, *item.as_table(), case_table(spec), "",
                    fmt::format("{}.{}", path_, key));
    entry.indices_ = indices_;
    for (CaseTable& copy : entry.copies()) {
      result.push_back(std::move(copy));
    }
  }
  return result;
}

}  // namespace meniscus::reader
