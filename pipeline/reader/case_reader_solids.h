/// Solids of kind "step": from the file to faces, rims and their curves. Part
/// of the case-file reader.
#pragma once

#include <string>
#include <vector>

#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

bool is_step_solid(const CaseTable& table);

/// Those among the solids, and the curves of their rims; after the curves,
/// before the films.
void read_step_solids(CaseContext& context,
                      const std::vector<CaseTable>& solids,
                      case_data::Case& result);

/// The faces of the solid of that name among the solids; none where it could
/// not be read.
void add_step_faces(const std::string& name, case_data::Case& result);

}  // namespace meniscus::reader
