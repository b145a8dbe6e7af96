/// Parts of the reader of [study], by kind of study.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/case_reader_tables.h"

namespace meniscus {

/// Methods of a sweep.
std::vector<std::string> sweep_methods();

/// What a sweep looks at; after the method.
void read_sweep(CaseContext& context, const CaseTable& table, Case& result);

/// Standard deviations and samples; after the method.
void read_tolerance(CaseContext& context, const CaseTable& table, Case& result);

/// Index of the response with that name; nothing, and a note, without one.
std::optional<int> find_response(CaseContext& context, const Case& result,
                                 const std::string& name, SourceLine line);

/// The two objectives and the number of points; before the constraints.
void read_front(CaseContext& context, const CaseTable& table, Case& result);

}  // namespace meniscus
