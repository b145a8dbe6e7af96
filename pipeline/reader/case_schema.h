/// The one table of the case file's vocabulary: the reader checks against it,
/// the JSON schema for editors and the reference in docs/case-file.md are
/// written from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/units.h"

namespace meniscus::reader {

enum class KeyType {
  Text,
  Choice,          // one of `choices`
  Name,            // of something defined elsewhere in the file
  Names,           // array of names
  NameOrNames,     // one, or an array of them
  NamesOrNumbers,  // one or an array of them, of things in a file
  Integer,
  Counts,          // one to three integers
  Shape,           // the same, as numbers alone
  Flag,            // true or false
  Sides,           // the same, or an array of integers
  Quantity,        // number, expression or "value unit"
  Quantities,      // one, or an array of them
  Constant,        // a quantity that no design variable moves
  Place,           // a quantity, or an expression that also knows x, y, z
  Field,           // the same, and the case's shapes
  Vector,          // array of three quantities
  Vectors,         // array of arrays of three quantities
  Facets,          // array of arrays of three or more integers
  Path,            // the same, or { through = [x, y, z] } between two
  ConstantVector,  // array of three constants
  PlaceVector,     // array of three places
  Axes,            // two arrays of three constants
  Rims,            // array of "base", "seat" or a quantity each; or of edges
  Elements,        // a constant, or nested arrays of them
  Bounds,          // array of two of these
  Constants,       // array of constants
  ConstantMap,     // inline table: response = constant, of its dimension
  IntegerMap,      // inline table: design variable = integer
  Start,           // text, or inline table: design variable = elements
  Supports,        // array of inline tables: table "support"
  Loads,           // array of inline tables: table "load"
  Zones,           // array of inline tables: table "exclude"
  Spheroids,       // array of inline tables: table "drop"
  Layers,          // array of inline tables: table "layer"
  Planes,          // array of inline tables: table "plane"
  Constraints,     // array of inline tables: table "constraint"
  Members          // tables by name, or the name of a csv file
};

struct KeySpec {
  const char* key;
  KeyType type;
  std::optional<Dimension> dimension;  // none: any
  bool required;
  std::string doc;
  std::string choices = "";  // "a|b|c"
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
  std::string doc;
  std::vector<KeySpec> keys;
};

/// All tables, in the order of the reference.
const std::vector<TableSpec>& case_tables();

// Those of them that have kinds; each stands in the file that reads it, with
// the kinds' rows (pipeline/case_data/case_kinds.h).
TableSpec curve_table();     // case_reader_curves.cpp
TableSpec film_table();      // case_reader_films.cpp
TableSpec drop_table();      // the same
TableSpec solid_table();     // the same
TableSpec wall_table();      // case_reader_walls.cpp
TableSpec shell_table();     // the same
TableSpec layer_table();     // the same
TableSpec fillet_table();    // the same
TableSpec shape_table();     // case_reader_shapes.cpp
TableSpec field_table();     // case_reader_energies.cpp
TableSpec spine_table();     // the same
TableSpec bolt_table();      // case_reader_loads.cpp
TableSpec load_table();      // the same
TableSpec analysis_table();  // case_reader_analysis.cpp
TableSpec response_table();  // case_reader_responses.cpp
TableSpec study_table();     // case_reader_kinds.cpp

/// The table of that name; must exist.
const TableSpec& case_table(const std::string& name);

/// The key of that name, or nothing.
const KeySpec* find_key(const TableSpec& table, const std::string& key);

/// The parts of "a|b|c".
std::vector<std::string> split_choices(const std::string& choices);

/// "a, b or c".
std::string either_of(std::vector<std::string> names);

/// Tables of the entries of an array, not of the file's own.
bool is_entry_table(const std::string& name);

/// Tables of later versions: refused by name instead of "unknown".
bool is_later_table(const std::string& name);

/// A JSON schema (draft 2020-12) of the file, for editors.
std::string json_schema();

/// The reference's tables as markdown; docs/case-file.md holds them.
std::string schema_markdown();

}  // namespace meniscus::reader
