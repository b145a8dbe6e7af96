/// Whether a VTK file holds what its head says, before VTK believes the head: a
/// cut or damaged one makes its readers ask for all memory.
#pragma once

#include <filesystem>

namespace meniscus::page {

/// Reads the bytes of a .vtu or .vtp file as this program writes them (arrays
/// appended, raw or compressed). Throws InvalidInput where the file ends early,
/// an array lies outside of it or claims more values than its bytes can hold,
/// or there are more points or cells than values; IoError.
void check_vtk_bounds(const std::filesystem::path& path);

}  // namespace meniscus::page
