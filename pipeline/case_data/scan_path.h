/// Where a case's scans lie.
#pragma once

#include <filesystem>
#include <string>

#include "pipeline/case_data/case.h"

namespace meniscus::case_data {

/// Where a case's scan lies: beside the case file, where it is not absolute.
inline std::filesystem::path scan_path(const Case& input,
                                       const std::string& scan) {
  return std::filesystem::path(input.path).parent_path() / scan;
}

}  // namespace meniscus::case_data
