/// Scans that a case compares its films with.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "evolve/frozen/film_model.h"
#include "evolve/scan/scan.h"
#include "pipeline/case_data/case.h"

namespace meniscus::responses {

/// By the path that responses name.
using Scans = std::map<std::string, std::shared_ptr<const scan::Scan>>;

/// Those of the case's responses of kind scan_distance, read from their files:
/// STL, OBJ or STEP. Throws IoError or InvalidInput, naming the response's
/// line, for files that cannot be read, or are others than those that the case
/// was read with.
Scans read_scans(const case_data::Case& input);

/// Distances of a design's film to the scan of a response of kind
/// scan_distance.
scan::ScanDistances scan_distances(const case_data::ResponseEntry& response,
                                   const Scans& scans,
                                   const frozen::FilmModel& film,
                                   const Points& points);

}  // namespace meniscus::responses
