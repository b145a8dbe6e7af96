/// Design variables as people name them: one by one, or a vector as one.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case_data/case.h"

namespace meniscus::case_data {

/// One design variable, or all elements of a vector.
struct DesignRow {
  std::string name;                      // "foot", "t"
  const DesignVector* vector = nullptr;  // of the case; none: one variable
  std::size_t first = 0;                 // among the design variables
  std::size_t count = 1;

  /// "foot", "t [8 x 12]".
  std::string label() const;
};

/// All design variables, in their order. Rows refer to the case.
std::vector<DesignRow> design_rows(const Case& input);

/// The rows' names.
std::vector<std::string> row_names(const Case& input);

/// Where the design variables of that name stand: "foot"; "t", all elements of
/// it; "t[2, 3]", one. None for an unknown name.
std::vector<std::size_t> positions_of(const Case& input,
                                      const std::string& name);

/// What people are shown of a row at a design: "25 mm", of a vector "0.71 to
/// 1.42 mm, mean 1.03 mm" or "1 mm each".
std::string row_text(const Case& input, const DesignRow& row,
                     const VectorX& design, int digits = 6);

/// "foot = 25 mm, t = 0.71 to 1.42 mm, mean 1.03 mm".
std::string design_text(const Case& input, const VectorX& design);

}  // namespace meniscus::case_data
