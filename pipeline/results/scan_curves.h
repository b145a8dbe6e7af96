/// `meniscus curves`: what a scan proposes as curves of a case.
#pragma once

#include <filesystem>
#include <string>

#include "evolve/scan/scan_rims.h"

namespace meniscus::results {

/// A part of a case file: [curves.rim_1], [curves.rim_2], ..., splines of few
/// points, each with comments that tell its plane, size and quality. `scan`: as
/// comments name it.
std::string curves_text(const scan::ScanRimReport& report,
                        const std::string& scan);

/// Reads an STL or OBJ file and looks for its rims. Throws what read_part_file
/// and find_rims throw, InvalidInput for another kind of file.
scan::ScanRimReport rims_of_scan(const std::filesystem::path& scan,
                                 const scan::ScanRimOptions& options);

}  // namespace meniscus::results
