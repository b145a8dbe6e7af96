/// A Surface Evolver datafile as plain data: what it says, names and element
/// numbers resolved, formulas not yet evaluated. Language: Brakke, Surface
/// Evolver manual 2.70, "Datafile format".
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "evolve/datafile/fe_expression.h"

namespace meniscus::datafile {

using FeField = std::array<FeExpression, 3>;

struct FeParameter {
  std::string name;  // in lower case
  FeExpression value;
  FePlace place;
};

/// Line integrals along the edges on a boundary or a constraint.
struct FeIntegrals {
  std::optional<FeField> energy;
  std::optional<FeField> content;
  bool convex = false;  // its edges carry gap energy
};

struct FeBoundary {
  std::string name;  // its number or name
  FeField coordinates;
  FeIntegrals integrals;
  FePlace place;
};

struct FeConstraint {
  enum class Side { On, Nonnegative, Nonpositive };
  std::string name;
  Side side = Side::On;
  bool global = false;  // holds all vertices
  FeExpression formula;
  FeIntegrals integrals;
  FePlace place;
};

struct FeMethod {
  enum class Kind { VectorIntegral, ScalarIntegral, Area, Volume };
  std::string name;  // of a method instance; empty within a quantity
  Kind kind = Kind::Area;
  FeField vector;        // VectorIntegral
  FeExpression scalar;   // ScalarIntegral
  FeExpression modulus;  // factor
  bool global = false;   // over every facet
  FePlace place;
};

struct FeQuantity {
  enum class Role { Energy, Fixed, Info };
  std::string name;
  Role role = Role::Info;
  FeExpression target;   // Fixed
  FeExpression modulus;  // factor
  std::vector<FeMethod> methods;
  FePlace place;
};

enum class FeElement { Vertices, Edges, Facets, Bodies };

/// An attribute that the file defines; 0 where no value is given.
struct FeAttribute {
  FeElement element = FeElement::Vertices;
  std::string name;
};

struct FeOnConstraint {
  int constraint = 0;     // index into constraints
  bool reversed = false;  // integrals run from head to tail
};

/// What vertices, edges and faces have in common.
struct FeMarks {
  bool fixed = false;
  bool no_refine = false;
  int boundary = -1;  // index into boundaries
  std::vector<FeOnConstraint> constraints;
  std::vector<int> quantities;                           // faces
  std::vector<std::pair<int, FeExpression>> attributes;  // index, value
  FePlace place;
};

struct FeVertex {
  int id = 0;                             // as in the file
  std::vector<FeExpression> coordinates;  // 3, or 1 on a boundary
  FeMarks marks;
};

struct FeEdge {
  int id = 0;
  int tail = 0;  // index into vertices
  int head = 0;
  FeMarks marks;
};

struct FeFace {
  int id = 0;
  std::vector<int> edges;  // +(index + 1), or -(index + 1): head to tail
  std::optional<FeExpression> tension;
  std::optional<FeExpression> color;
  FeMarks marks;
};

struct FeBody {
  int id = 0;
  std::vector<int> faces;  // +(index + 1) outward, -(index + 1) inward
  std::optional<FeExpression> volume;
  std::optional<FeExpression> pressure;
  std::optional<FeExpression> volconst;
  std::optional<FeExpression> density;
  FePlace place;
};

struct FeFile {
  std::string name;                     // for messages
  std::vector<FeParameter> parameters;  // a name's last value counts
  std::vector<FeAttribute> attributes;
  std::optional<FeExpression> gravity;       // default 1
  std::optional<FeExpression> gap_constant;  // default 1
  bool symmetric_content = false;
  int line_order = 3;  // exact degree of line integrals, as in Evolver
  std::vector<FeBoundary> boundaries;
  std::vector<FeConstraint> constraints;
  std::vector<FeQuantity> quantities;
  std::vector<FeVertex> vertices;
  std::vector<FeEdge> edges;
  std::vector<FeFace> faces;
  std::vector<FeBody> bodies;
  std::string commands;   // the `read` section, raw
  int commands_line = 0;  // of its first character; 0: there is none
};

/// Reads a datafile. `name` stands in messages. Throws InvalidInput
/// "name:line:column: what is wrong, found what" for broken syntax, unknown
/// names, numbers of elements that are not there, faces whose edges do not
/// close, and whatever films here cannot do (string and simplex models, tori,
/// metrics, ...). Colours and views are read and left out. Time grows linearly
/// with the text; memory with what it declares.
FeFile read_fe(std::string_view text, const std::string& name);

}  // namespace meniscus::datafile
