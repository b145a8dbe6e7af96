/// What a parsed case file says, free of how it is written. Part of the
/// case-file reader.
#pragma once

#include <string>
#include <string_view>

#include <toml++/toml.h>

namespace meniscus::reader {

/// One text for all files whose evaluations agree bit for bit: comments,
/// spacing, the order of tables and of keys, and 8 against 8.0 make no
/// difference; the order of entries within a table does ([curves.a] before
/// [curves.b]), because models follow it. Left out is what no evaluation
/// depends on: title, [process], resolution.export, the eigenvalues of
/// [analysis] and study.tolerance, study.method, study.max_evaluations and a
/// family's table of members, which its members' evaluations do not depend on.
std::string canonical_text(const toml::table& root);

/// The same with all that a study's answer depends on: left out are title, time
/// limits and a family's table of members. Rows added to that leave the answers
/// of the others what they are.
std::string canonical_answer_text(const toml::table& root);

/// The first line with a dotted key of more than 30 parts, or 0. The TOML
/// library recurses by them without a limit of its own.
int line_of_deep_key(std::string_view text);

}  // namespace meniscus::reader
