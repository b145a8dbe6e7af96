/// VTK's XML files as plain arrays, for the report page.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/types.h"

namespace meniscus::page {

/// What one file holds: cells of one size, all of a cell's points before the
/// next; arrays by name, all components of an item before the next.
struct VtkInput {
  Points points;
  int cell_size = 0;  // points per cell; 0: no cells
  std::vector<int> cells;
  std::vector<int> vertices;  // points of a .vtp's single vertices; what
                              // cell_data has of them comes first
  std::map<std::string, std::vector<double>> point_data;
  std::map<std::string, std::vector<double>> cell_data;
  std::map<std::string, std::vector<std::string>> texts;  // of the field data
};

/// Polygons of a .vtp, or cells of a .vtu; arrays named in `skipped` are not
/// read. Throws InvalidInput, naming the file, for one that is missing,
/// damaged, of another kind, or mixes cells of several sizes.
VtkInput read_vtk(const std::filesystem::path& path,
                  const std::vector<std::string>& skipped = {});

/// Throws InvalidInput: the file, what is wrong with it, what to do.
[[noreturn]] void refuse_file(const std::filesystem::path& path,
                              const std::string& what);

}  // namespace meniscus::page
