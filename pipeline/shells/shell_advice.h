/// When films are analysed better as shells, and when as solids.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/case_data/case.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::shells {

/// Sentences for walls thinner than the elements' edges, in a case that shells
/// can stand for: one element through them reads stress too low, and such
/// elements are flat. `films`: points of each film's mesh, by name; without
/// them walls are measured on their films' curves.
std::vector<std::string> thin_wall_advice(
    const case_data::Case& input, const case_data::EvaluatedCase& inputs,
    const std::map<std::string, Points>& films = {});

/// Sentences for shells thicker than a fifth of the smallest radius of
/// curvature of their films' curves; of flat films none.
std::vector<std::string> thick_shell_advice(
    const case_data::Case& input, const case_data::EvaluatedCase& inputs);

/// The same of the settled film, away from its rims.
std::vector<std::string> thick_shell_warnings(const case_data::Case& input,
                                              const ShellPart& part);

/// All that a case says of itself, at its initial design; nothing for one that
/// has no values there.
std::vector<std::string> shell_advice(const case_data::Case& input);

}  // namespace meniscus::shells
