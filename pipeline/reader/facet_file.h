/// Facets that films and solids start from, out of files.
#pragma once

#include <memory>
#include <string>

#include "pipeline/case_data/case.h"

namespace meniscus::reader {

/// The facets of a file that the case names by `path` (.stl, .obj, .fe), or of
/// its surface of that name alone, their lengths times `scale`. The case keeps
/// them as text (OBJ) in the file's place, and reads them from there when it
/// has them.
///
/// Of a datafile: its films (or one kind of them) with straight edges as they
/// stand in it; bodies, volumes and fixed vertices are the case's business.
/// Throws InvalidInput (another ending, no such surface, a datafile whose films
/// hang on constraints or boundaries or have energies of their own), IoError,
/// and what the format's reader throws.
std::shared_ptr<const films::StartFacets> start_from_file(
    case_data::Case& input, const std::string& path, const std::string& surface,
    double scale);

}  // namespace meniscus::reader
