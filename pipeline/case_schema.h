/// The one table of the case file's vocabulary: the reader checks against it,
/// the JSON schema for editors and the reference in docs/case-file.md are
/// written from it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/units.h"

namespace meniscus {

enum class KeyType {
  Text,
  Choice,  // one of `choices`
  Name,    // of something defined elsewhere in the file
  Names,   // array of names
  Number,  // plain number
  Integer,
  Quantity,   // number, expression or "value unit"
  Vector,     // array of three quantities
  Vectors,    // array of arrays of three quantities
  Bounds,     // array of two plain numbers
  Numbers,    // array of plain numbers
  NumberMap,  // inline table: name = number
  Supports,   // array of inline tables: table "support"
  Loads       // array of inline tables: table "load"
};

struct KeySpec {
  const char* key;
  KeyType type;
  Dimension dimension;
  bool required;
  const char* doc;
  const char* choices = "";  // "a|b|c"
};

struct TableSpec {
  const char* name;    // "curves"; "" for the file's top
  bool named_entries;  // [curves.NAME]
  bool required;       // at least one entry
  const char* doc;
  std::vector<KeySpec> keys;
};

/// All tables, in the order of the reference.
const std::vector<TableSpec>& case_tables();

/// The entry of that name; must exist.
const TableSpec& case_table(const std::string& name);

/// Tables of later versions: refused by name instead of "unknown".
bool is_later_table(const std::string& name);

std::string json_schema();

/// The reference's tables as markdown.
std::string schema_markdown();

}  // namespace meniscus
