/// Kinds of one table of the case file, one row each: the list that the reader,
/// the schema and the reference are made from. A row has at least a `name`, as
/// the file writes it; rows with a `doc` say what the reference tells of them.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus::case_data {

/// The keys that one kind of entry has beside `kind`.
struct KindKeys {
  std::vector<std::string> needed;
  std::vector<std::string> optional;
};

/// A row that has no more than a value.
template <class Value>
struct Named {
  const char* name;
  Value value;
};

// In place of a row's doc; empty, its name tells enough:
inline constexpr std::string_view kWithNext = "+";  // the next row's is of both
inline constexpr std::string_view kSaidElsewhere = "-";  // in another row's

/// "a|b|c", as KeySpec::choices has it.
template <class Row>
std::string choices_of(const std::vector<Row>& rows) {
  std::string text;
  for (const Row& row : rows) {
    text += (text.empty() ? "" : "|") + std::string(row.name);
  }
  return text;
}

/// How meanings_of() sets names and texts.
struct MeaningStyle {
  const char* before = ": ";
  const char* after = "";
  const char* between = "; ";
};

/// "a, b: what both are; c: what it is".
template <class Row>
std::string meanings_of(const std::vector<Row>& rows,
                        const MeaningStyle& style = {}) {
  std::string text;
  std::string names;
  for (const Row& row : rows) {
    const std::string_view doc = row.doc;
    if (doc == kSaidElsewhere) {
      continue;
    }
    names += (names.empty() ? "" : ", ") + std::string(row.name);
    if (doc == kWithNext) {
      continue;
    }
    text += (text.empty() ? "" : style.between) + names;
    if (!doc.empty()) {
      text += style.before + std::string(doc) + style.after;
    }
    names.clear();
  }
  return text;
}

/// The row of that name; it must exist, as a checked choice does.
template <class Row>
const Row& row_named(const std::vector<Row>& rows, const std::string& name) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const Row& row) { return name == row.name; });
}

}  // namespace meniscus::case_data
