/// Parts of the reader of [study], by kind of study.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case_reader_tables.h"

namespace meniscus {

/// Methods of a sweep.
std::vector<std::string> sweep_methods();

/// What a sweep looks at; after the method.
void read_sweep(CaseContext& context, const CaseTable& table, Case& result);

}  // namespace meniscus
