/// The one table of the case file's vocabulary: the reader checks against it,
/// the JSON schema for editors and the reference in docs/case-file.md are
/// written from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/units.h"

namespace meniscus {

enum class KeyType {
  Text,
  Choice,          // one of `choices`
  Name,            // of something defined elsewhere in the file
  Names,           // array of names
  NamesOrNumbers,  // one or an array of them, of things in a file
  Integer,
  Counts,          // one to three integers
  Flag,            // true or false
  Quantity,        // number, expression or "value unit"
  Constant,        // a quantity that no design variable moves
  Place,           // a quantity, or an expression that also knows x, y, z
  Vector,          // array of three quantities
  Vectors,         // array of arrays of three quantities
  Facets,          // array of arrays of three or more integers
  Path,            // the same, or { through = [x, y, z] } between two
  ConstantVector,  // array of three constants
  PlaceVector,     // array of three places
  Axes,            // two arrays of three constants
  Bounds,          // array of two constants
  Constants,       // array of constants
  ConstantMap,     // inline table: response = constant, of its dimension
  IntegerMap,      // inline table: design variable = integer
  Supports,        // array of inline tables: table "support"
  Loads,           // array of inline tables: table "load"
  Zones,           // array of inline tables: table "exclude"
  Constraints,     // array of inline tables: table "constraint"
  Members          // tables by name, or the name of a csv file
};

struct KeySpec {
  const char* key;
  KeyType type;
  std::optional<Dimension> dimension;  // none: any
  bool required;
  const char* doc;
  const char* choices = "";  // "a|b|c"
  const char* later = "";    // choices of later versions, refused by name
};

enum class TableNeed {
  Optional,
  Always,   // at least one entry
  ForParts  // the same, unless the case has walls and no bodies
};

struct TableSpec {
  const char* name;    // "curves"; "" for the file's top
  bool named_entries;  // [curves.NAME]
  TableNeed need;
  const char* doc;
  std::vector<KeySpec> keys;
};

/// All tables, in the order of the reference.
const std::vector<TableSpec>& case_tables();

/// Those of them that the liquid starts from (case_schema_shapes.cpp).
std::vector<TableSpec> shape_tables();
/// [walls.NAME] (case_schema_walls.cpp).
TableSpec walls_table();

/// Those of them that say what is asked of the part
/// (case_schema_responses.cpp), and what to do with it (case_schema_study.cpp).
std::vector<TableSpec> response_tables();
std::vector<TableSpec> study_tables();

/// The table of that name; must exist.
const TableSpec& case_table(const std::string& name);

/// The key of that name, or nothing.
const KeySpec* find_key(const TableSpec& table, const std::string& key);

/// The parts of "a|b|c".
std::vector<std::string> split_choices(const char* choices);

/// Tables of the entries of an array, not of the file's own.
bool is_entry_table(const std::string& name);

/// Tables of later versions: refused by name instead of "unknown".
bool is_later_table(const std::string& name);

/// A JSON schema (draft 2020-12) of the file, for editors.
std::string json_schema();

/// The reference's tables as markdown; docs/case-file.md holds them.
std::string schema_markdown();

}  // namespace meniscus
