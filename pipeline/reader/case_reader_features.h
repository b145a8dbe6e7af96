/// Bosses, flanges, lugs and blocks of [solids.NAME]: from the file to curves
/// and faces. Part of the case-file reader.
#pragma once

#include <string>
#include <vector>

#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

struct FeatureRow {
  const char* name;
  case_data::FeatureKind kind;
  case_data::KindKeys keys;
  std::string_view doc;
};
const std::vector<FeatureRow>& feature_kinds();

bool is_feature(const CaseTable& table);

/// Those among the solids, and their edges among the curves; after the curves,
/// before the films.
void read_features(CaseContext& context, const std::vector<CaseTable>& solids,
                   case_data::Case& result);

/// The faces of the feature of that name, which must exist, among the solids.
void add_feature_faces(const std::string& name, case_data::Case& result);

/// Each name of a feature or STEP solid replaced by those of its faces.
std::vector<std::string> with_feature_faces(
    const case_data::Case& input, const std::vector<std::string>& names);

}  // namespace meniscus::reader
