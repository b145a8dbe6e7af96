/// Where a case's scans lie.
#pragma once

#include <filesystem>
#include <string>

#include "pipeline/case_data/case.h"

namespace meniscus::case_data {

/// Where a case's scan lies: beside the case file, where it is not absolute.
std::filesystem::path scan_path(const Case& input, const std::string& scan);

}  // namespace meniscus::case_data
