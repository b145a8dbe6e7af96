/// Points of a boundary curve from a csv file.
#pragma once

#include <string>
#include <vector>

#include "core/types.h"
#include "core/units.h"

namespace meniscus::files {

struct CurveFile {
  Points points;                      // in case units, in the order of the rows
  std::vector<std::string> problems;  // "FILE:LINE: what, found, expected, try"
  std::string warning = {};  // of a rim that ends far from where it began
};

/// RFC 4180 with a head row that names the columns x, y, z in any order, each
/// with its unit if it likes: "x [in]" or "x (in)"; other columns are left out.
/// A last row that repeats the first is left out too: curves close by
/// themselves; one whose ends are much further apart than its other points is
/// warned of. `path`: as messages name it.
CurveFile read_curve_text(const std::string& text, const std::string& path,
                          const UnitSystem& units);

}  // namespace meniscus::files
