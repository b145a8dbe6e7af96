#include "pipeline/case_data/scan_path.h"

namespace meniscus::case_data {

std::filesystem::path scan_path(const Case& input, const std::string& scan) {
  return std::filesystem::path(input.path).parent_path() / scan;
}

}  // namespace meniscus::case_data
