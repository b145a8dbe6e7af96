/// Typed access to the tables of a case file: each value is checked against
/// the vocabulary (pipeline/reader/case_schema.h), and what is wrong is noted
/// with its line. Part of the case-file reader; nothing else sees TOML.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "core/units.h"
#include "pipeline/case_data/case_entries.h"
#include "pipeline/case_data/case_kinds.h"
#include "pipeline/case_data/case_problems.h"
#include "pipeline/reader/case_schema.h"

namespace meniscus::step {
class StepEdges;
}

namespace meniscus::reader {

/// Of one vector of design variables.
inline constexpr int kMostElements = 4000;

/// Nodes that overrides put into the file: the override's number, from 1.
using OverriddenNodes = std::map<const toml::node*, int>;

/// What all entries of one file share.
struct CaseContext {
  case_data::CaseProblems& problems;
  const OverriddenNodes& overridden;
  UnitSystem units;
  std::vector<std::string> names;  // that expressions know, by position
  std::vector<char> used;          // per name: some expression has it
  // Per name: its value when no design variable moves it.
  std::vector<std::optional<double>> constants;
  // Per name, as far as it is known; empty while parameters are read.
  std::vector<Measure> measures;
  std::vector<std::string> shapes;    // of fields, by position
  std::set<std::size_t> used_shapes;  // some expression has them
  // There are bodies, walls or shells, and nothing was wrong with bodies.
  bool bodies_good = false;
  /// What can be loaded, once a load has asked: walls and shells are read.
  std::optional<std::vector<std::string>> surfaces;
  // Of the copy of an entry with `repeat` that is being read: i, j, k.
  std::vector<int> indices;
  std::map<std::string, std::shared_ptr<step::StepEdges>>
      step_files;  // by path

  case_data::SourceLine line_of(const toml::node& node) const;
};

/// A constant and the dimension of its text.
struct Constant {
  double value = 0.0;
  Measure measure;
};

/// "a table", "text 'abc'", "3.5": what was found, for messages.
std::string described(const toml::node& node);

/// One table of the file, such as [curves.support], and its place.
class CaseTable {
 public:
  /// Notes unknown keys and missing ones that are required.
  CaseTable(CaseContext& context, const toml::table& table,
            const TableSpec& spec, std::string name, std::string path);

  /// What `repeat` makes of the table, in order: itself without that, else
  /// NAME_1, NAME_2, ... or NAME_1_1, ..., whose expressions and names know
  /// their numbers as i, j, k.
  std::vector<CaseTable> copies() const;

  const std::string& name() const { return name_; }
  const std::string& path() const { return path_; }
  case_data::SourceLine line() const { return context_->line_of(*table_); }
  /// Of the key's value, or of the table when it is not there.
  case_data::SourceLine line(const char* key) const;
  bool has(const char* key) const { return table_->contains(key); }
  /// Notes keys that an entry of this kind lacks or should not have.
  void check_kind(const std::string& kind,
                  const case_data::KindKeys& keys) const;

  // Absent or wrong values come back empty; wrong ones have been noted.
  std::optional<std::string> text(const char* key) const;
  std::optional<std::string> choice(const char* key) const;
  /// Names, and { name = "x_{i}", repeat = n } for several.
  std::vector<std::string> names(const char* key) const;
  /// One, or as names().
  std::vector<std::string> name_or_names(const char* key) const;
  /// One or several; numbers as text.
  std::vector<std::string> names_or_numbers(const char* key) const;
  std::optional<bool> flag(const char* key) const;
  std::optional<int> positive_integer(const char* key) const;
  std::optional<int> integer_within(const char* key, int least, int most) const;
  std::optional<case_data::Quantity> quantity(const char* key) const;
  /// One or several.
  std::vector<case_data::Quantity> quantities(const char* key) const;
  /// Of a key of type Place, or Field.
  std::optional<case_data::PlaceQuantity> place_quantity(const char* key) const;
  std::optional<double> constant(const char* key) const;
  /// Of that dimension, whatever the vocabulary says.
  std::optional<double> constant(const char* key, Dimension dimension) const;
  /// The same with the dimension of its text.
  std::optional<Constant> measured(const char* key) const;
  std::vector<double> constants(const char* key) const;
  std::optional<case_data::QuantityVector> vector(const char* key) const;
  /// Points, and { at = [x, y, z], repeat = n } for several.
  std::vector<case_data::QuantityVector> vectors(const char* key) const;
  /// Three or more corners each, cut into triangles from the first; numbers
  /// from 0 of so many vertices.
  std::vector<Triangle> facets(const char* key, std::ptrdiff_t vertices) const;
  /// As vectors(), with points that arcs go through: { through = [x, y, z] }.
  std::vector<case_data::PathPoint> path_points(const char* key) const;
  std::optional<Vec3> constant_vector(const char* key) const;
  /// Of that dimension, whatever the vocabulary says.
  std::optional<Vec3> constant_vector(const char* key,
                                      Dimension dimension) const;
  std::optional<std::array<case_data::PlaceQuantity, 3>> place_vector(
      const char* key) const;
  std::optional<element::LocalAxes> axes(const char* key) const;
  /// The array's tables, checked against the vocabulary's table `spec`.
  std::vector<CaseTable> tables(const char* key, const char* spec) const;

  /// As quantity() and vector(), with 0 for absent or wrong values.
  case_data::Quantity quantity_or_zero(const char* key) const;
  case_data::QuantityVector vector_or_zero(const char* key) const;

  const toml::node* node(const char* key) const { return table_->get(key); }

 private:
  /// Of three items; null with a problem noted where it is anything else.
  const toml::array* three(const char* key, const char* wanted) const;
  std::optional<Vec3> constants_of(const toml::node& node,
                                   std::optional<Dimension> dimension,
                                   const std::string& path) const;
  void note(const char* key, const std::string& expected) const;
  /// Notes a vector whose components are of different dimensions.
  void require_alike(const std::array<Measure, 3>& measures,
                     const toml::node& node, const std::string& path) const;
  std::string filled_text(const toml::node& node, const std::string& text,
                          const std::vector<int>& indices) const;
  /// The numbers of the copies that an entry { ..., repeat = n } of an array
  /// makes; the table's own for one without.
  std::vector<std::vector<int>> copies_in(const char* key,
                                          const toml::table& entry) const;
  bool add_names(const char* key, const toml::node& item,
                 std::vector<std::string>& result) const;
  std::optional<Dimension> dimension(const char* key) const;

  CaseContext* context_;
  const toml::table* table_;
  const TableSpec* spec_;
  std::string name_;
  std::string path_;
  std::vector<int> indices_;  // of this copy; none without repeat
};

/// While it lives, expressions know the numbers of one copy.
class IndexScope {
 public:
  IndexScope(CaseContext& context, const std::vector<int>& indices)
      : context_(context) {
    context_.indices = indices;
  }
  ~IndexScope() { context_.indices.clear(); }
  IndexScope(const IndexScope&) = delete;
  IndexScope& operator=(const IndexScope&) = delete;

 private:
  CaseContext& context_;
};

/// A number, an expression or a value with a unit; nothing, and a note, when
/// it is none. `dimension`: none allows any.
std::optional<case_data::Quantity> read_quantity(
    CaseContext& context, const toml::node& node,
    std::optional<Dimension> dimension, const std::string& key);

/// The same for a quantity that may also be an expression of x, y, z and of
/// more names after these.
std::optional<case_data::PlaceQuantity> read_place_quantity(
    CaseContext& context, const toml::node& node,
    std::optional<Dimension> dimension, const std::string& key,
    const std::vector<std::string>& more = {});

/// The dimension of an expression over the context's names; where two parts do
/// not fit each other, a note and nothing known.
Measure measure_of(CaseContext& context, const case_data::Quantity& quantity);

/// Notes a quantity whose dimension is known and another.
void require_powers(CaseContext& context, const case_data::Quantity& quantity,
                    const UnitPowers& powers);

/// Notes a quantity that a design variable moves although `what`, of which it
/// is a part, belongs to the frozen film.
void require_frozen(CaseContext& context, const case_data::Quantity& quantity,
                    const char* what);

/// The same where no design variable may have a say.
std::optional<Constant> read_measured(CaseContext& context,
                                      const toml::node& node,
                                      std::optional<Dimension> dimension,
                                      const std::string& key);

/// Its value alone.
std::optional<double> read_constant(CaseContext& context,
                                    const toml::node& node,
                                    std::optional<Dimension> dimension,
                                    const std::string& key);

}  // namespace meniscus::reader
