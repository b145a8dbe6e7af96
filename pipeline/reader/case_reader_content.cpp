#include "pipeline/reader/case_reader_content.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <vector>

#include <fmt/format.h>

namespace meniscus::reader {

namespace {

constexpr int kMostDots = 30;

void write(const toml::node& node, std::string& text);

void write(std::string_view word, std::string& text) {
  text += fmt::format("{}:{}", word.size(), word);  // no two texts look alike
}

void write_table(const toml::table& table, const std::set<std::string>& skip,
                 std::string& text) {
  text += '{';
  for (const auto& [key, node] : table) {  // sorted by name
    if (skip.count(std::string(key.str())) == 0) {
      write(key.str(), text);
      text += '=';
      write(node, text);
    }
  }
  text += '}';
}

bool holds_only(const toml::table& table, const std::set<std::string>& keys) {
  return std::all_of(table.begin(), table.end(), [&](const auto& entry) {
    return keys.count(std::string(entry.first.str())) > 0;
  });
}

void write(const toml::node& node, std::string& text) {
  if (const toml::table* table = node.as_table()) {
    write_table(*table, {}, text);
  } else if (const toml::array* array = node.as_array()) {
    text += '[';
    for (const toml::node& item : *array) {
      write(item, text);
    }
    text += ']';
  } else if (const auto* word = node.as_string()) {
    write(word->get(), text);
  } else if (node.is_number()) {
    text += fmt::format("#{};", *node.value<double>());
  } else {
    std::ostringstream other;  // booleans, and dates, which no key takes
    other << toml::node_view<const toml::node>(node);
    write(other.str(), text);
  }
}

void write_entries(const toml::table& entries, std::string& text) {
  std::vector<std::pair<toml::source_index, std::string>> order;
  for (const auto& [key, node] : entries) {
    order.emplace_back(node.source().begin.line, key.str());
  }
  std::stable_sort(
      order.begin(), order.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [line, name] : order) {
    write(name, text);
    text += '=';
    write(*entries.get(name), text);
  }
}

/// Past the string that starts at `at`.
std::size_t skip_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view triple = quote == '"' ? "\"\"\"" : "'''";
  const bool lines = text.substr(at, 3) == triple;
  at += lines ? 3 : 1;
  while (at < text.size() && (lines || text[at] != '\n')) {
    if (quote == '"' && text[at] == '\\') {
      at += 2;
    } else if (lines && text.substr(at, 3) == triple) {
      at += 3;
      // Up to two more quotes belong to the string.
      for (int k = 0; k < 2 && at < text.size() && text[at] == quote; ++k) {
        ++at;
      }
      return at;
    } else if (!lines && text[at] == quote) {
      return at + 1;
    } else {
      ++at;
    }
  }
  return std::min(at, text.size());
}

}  // namespace

namespace {

/// Tables whose models follow the order of their entries.
const std::set<std::string>& ordered_tables() {
  static const std::set<std::string> names = {
      "design",    "curves",     "films",     "solids", "bodies",
      "fillets",   "walls",      "shells",    "fields", "spines",
      "materials", "load_cases", "responses", "bolts"};
  return names;
}

/// A response of kind frequency that is held as analysis.supports_of says.
bool frequency_without_supports(const toml::table& root) {
  const toml::table* responses = root["responses"].as_table();
  return responses != nullptr &&
         std::any_of(responses->begin(), responses->end(), [](auto&& entry) {
           const toml::table* table = entry.second.as_table();
           return table != nullptr &&
                  (*table)["kind"].value_or(std::string()) == "frequency" &&
                  !table->contains("load_case");
         });
}

}  // namespace

std::string canonical_answer_text(const toml::table& root) {
  std::string text = "meniscus-answer-1;";
  for (const auto& [key, node] : root) {
    const std::string name(key.str());
    const toml::table* table = node.as_table();
    if (name == "title") {
      continue;
    }
    write(name, text);
    text += '=';
    if (table != nullptr && ordered_tables().count(name) > 0) {
      write_entries(*table, text);
    } else if (table != nullptr && name == "study") {
      write_table(*table, {"members", "time_limit"}, text);
    } else {
      write(node, text);
    }
  }
  return text;
}

namespace {

/// Keys of analysis that no evaluation depends on.
std::set<std::string> keys_of_answers(const toml::table& root) {
  std::set<std::string> keys = {"frequencies", "buckling"};
  if (!frequency_without_supports(root)) {
    keys.insert("supports_of");
  }
  return keys;
}

}  // namespace

std::string canonical_text(const toml::table& root) {
  const std::set<std::string> eigenvalues = keys_of_answers(root);
  std::string text = "meniscus-case-1;";
  for (const auto& [key, node] : root) {
    const std::string name(key.str());
    const toml::table* table = node.as_table();
    if (name == "title" || name == "process" ||
        (name == "analysis" && table != nullptr &&
         holds_only(*table, eigenvalues))) {
      continue;
    }
    write(name, text);
    text += '=';
    if (table != nullptr && ordered_tables().count(name) > 0) {
      write_entries(*table, text);
    } else if (table != nullptr && name == "study") {
      write_table(*table,
                  {"tolerance", "method", "max_evaluations", "coarse_first",
                   "time_limit", "refreeze", "levels", "count", "seed",
                   "deviations", "each", "members"},
                  text);
    } else if (table != nullptr && name == "analysis") {
      write_table(*table, eigenvalues, text);
    } else if (table != nullptr && name == "resolution") {
      write_table(*table, {"export"}, text);
    } else {
      write(node, text);
    }
  }
  return text;
}

int line_of_deep_key(std::string_view text) {
  int line = 1;
  int dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      const std::size_t end = skip_string(text, at);
      line += static_cast<int>(
          std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                     text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      at = end;
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (c == '.') {
      if (++dots > kMostDots) {
        return line;
      }
    } else if (c == '=' || c == ',' || c == '[' || c == ']' || c == '{' ||
               c == '}' || c == '\n') {
      dots = 0;
    }
    line += c == '\n' ? 1 : 0;
    ++at;
  }
  return 0;
}

}  // namespace meniscus::reader
