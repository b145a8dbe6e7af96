#include "pipeline/case_data/design_vectors.h"

#include <algorithm>

#include <fmt/format.h>

namespace meniscus::case_data {

std::string DesignRow::label() const {
  return vector == nullptr
             ? name
             : fmt::format("{} [{}]", name, shape_text(vector->shape));
}

std::vector<DesignRow> design_rows(const Case& input) {
  std::vector<DesignRow> rows;
  auto vector = input.vectors.begin();
  for (std::size_t k = 0; k < input.design.size(); k += rows.back().count) {
    if (vector != input.vectors.end() && vector->first == k) {
      rows.push_back({vector->name, &*vector, k, vector->size()});
      ++vector;
    } else {
      rows.push_back({.name = input.design[k].name, .first = k});
    }
  }
  return rows;
}

std::vector<std::string> row_names(const Case& input) {
  std::vector<std::string> names;
  for (DesignRow& row : design_rows(input)) {
    names.push_back(std::move(row.name));
  }
  return names;
}

std::vector<std::size_t> positions_of(const Case& input,
                                      const std::string& name) {
  std::string plain = name;
  std::erase(plain, ' ');
  std::vector<std::size_t> positions;
  for (const DesignRow& row : design_rows(input)) {
    for (std::size_t k = row.first; k < row.first + row.count; ++k) {
      if (row.name == name || input.design[k].name == plain) {
        positions.push_back(k);
      }
    }
  }
  return positions;
}

std::string row_text(const Case& input, const DesignRow& row,
                     const VectorX& design, int digits) {
  const ShownUnit unit = shown_unit(input, input.design[row.first]);
  const auto values = design.segment(static_cast<Eigen::Index>(row.first),
                                     static_cast<Eigen::Index>(row.count));
  if (row.vector == nullptr) {
    return unit.text(values[0], digits);
  }
  if (values.minCoeff() == values.maxCoeff()) {
    return unit.text(values[0], digits) + " each";
  }
  return fmt::format("{:.{}g} to {}, mean {}", unit.factor * values.minCoeff(),
                     digits, unit.text(values.maxCoeff(), digits),
                     unit.text(values.mean(), digits));
}

std::string design_text(const Case& input, const VectorX& design) {
  std::string text;
  for (const DesignRow& row : design_rows(input)) {
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", row.name,
                        row_text(input, row, design));
  }
  return text;
}

}  // namespace meniscus::case_data
