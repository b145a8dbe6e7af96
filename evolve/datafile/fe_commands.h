/// Surface Evolver's command language, as far as datafiles use it to evolve
/// their films: parsed, not run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "evolve/datafile/fe_expression.h"

namespace meniscus::datafile {

/// "vertex vv where on_constraint 1": elements, one after the other.
struct FeElements {
  FeExpression path;                // "vertex", "body[1].facet", "edge[3]"
  std::string variable;             // name of the element at hand; may be empty
  std::vector<FeExpression> where;  // none or one
};

struct FeStatement {
  enum class Kind {
    Block,      // { body } repeated values[0] times, if given
    Define,     // name := { body }
    Assign,     // values[0] name values[1]; name is := += -= *= /=
    If,         // values[0]; body[0], perhaps body[1] (else)
    While,      // values[0]; body[0]
    DoWhile,    // body[0]; values[0]
    For,        // body[0]; values[0]; body[1]; body[2]
    Foreach,    // elements; body[0]
    Letter,     // name: one letter, case counts (g, G); values: its numbers
    Word,       // name: hessian, recalc, ...; values: none or one
    Toggle,     // name; values[0]: 1 on, 0 off; none: on
    Call,       // name of a Define, values[0] times if given
    Print,      // values[0]
    Printf,     // values[0] is the Text of the format
    Set,        // elements, name: attribute, values: none or one
    Unset,      // as Set
    Elements,   // name: refine, delete, ...; elements
    Attribute,  // define elements.path attribute name
    AddLoad,    // values[0]: the file
    Break,
    Continue
  };
  Kind kind = Kind::Block;
  std::string name;
  std::vector<FeExpression> values;
  std::vector<FeStatement> body;
  FeElements elements;
  FePlace place;
};

/// Parses commands, as in FeFile::commands. Throws InvalidInput
/// "name:line:column: what" for broken syntax, more than 100 levels of
/// nesting, words that are neither commands known here nor defined anywhere
/// in `text`.
std::vector<FeStatement> parse_commands(std::string_view text,
                                        const std::string& name,
                                        int first_line = 1);

}  // namespace meniscus::datafile
