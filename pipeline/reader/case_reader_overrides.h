/// --set name=value on a parsed case file. Part of the case-file reader.
#pragma once

#include <string>
#include <vector>

#include <toml++/toml.h>

#include "pipeline/case_data/case_problems.h"
#include "pipeline/reader/case_reader_fields.h"

namespace meniscus::reader {

/// Replaces values in `root` as the overrides say, each "name=value" with the
/// name of a parameter, of a design variable (its initial value) or a dotted
/// key. What was put in is returned, so that messages can name the override; a
/// name that is not there is a problem. The last of two for one key holds.
OverriddenNodes apply_overrides(toml::table& root,
                                const std::vector<std::string>& overrides,
                                case_data::CaseProblems& problems);

/// In a tolerance study parameters may scatter too: each that study.deviations
/// names becomes a design variable that stays at its value. `overridden` is
/// kept true.
void let_parameters_scatter(toml::table& root, OverriddenNodes& overridden);

}  // namespace meniscus::reader
