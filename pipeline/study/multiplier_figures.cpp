#include "pipeline/study/multiplier_figures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/case_data/design_vectors.h"

namespace meniscus::study {

namespace {

using Json = nlohmann::ordered_json;
using optimize::BindingBound;
using optimize::BoundSide;

constexpr double kPart = 0.01;         // of a bound
constexpr double kPartOfUnit = 0.001;  // of a bound of 0
constexpr std::size_t kMostLines = 12;

/// The name and the unit of what a bound is of.
struct Bounded {
  std::string name;
  ShownUnit shown;
};

Bounded bounded_by(const case_data::Case& input, const BindingBound& bound) {
  if (bound.of_variable) {
    const case_data::DesignVariable& variable = input.design[bound.index];
    return {variable.name, case_data::shown_unit(input, variable)};
  }
  const int response = input.study.constraints[bound.index].response;
  return {input.responses[static_cast<std::size_t>(response)].name,
          case_data::shown_unit(input, response)};
}

/// By what a bound gives way, signed.
double step_of(const BindingBound& bound, const ShownUnit& shown) {
  const double step = bound.bound == 0.0 ? kPartOfUnit / shown.factor
                                         : kPart * std::abs(bound.bound);
  return bound.side == BoundSide::Lower ? -step : step;
}

std::string bound_text(const BindingBound& bound, const ShownUnit& shown) {
  const std::string value = shown.text(bound.bound);
  return bound.side == BoundSide::Lower   ? "at least " + value
         : bound.side == BoundSide::Upper ? "at most " + value
                                          : "wanted " + value;
}

/// The vector whose element a bound is of; none: of nothing else.
std::optional<case_data::DesignRow> vector_with(
    const std::vector<case_data::DesignRow>& rows, const BindingBound& bound) {
  for (const case_data::DesignRow& row : rows) {
    if (bound.of_variable && row.vector != nullptr &&
        bound.index >= row.first && bound.index < row.first + row.count) {
      return row;
    }
  }
  return std::nullopt;
}

/// What people read of a bound, or of all bounds of a vector on one side.
struct Line {
  std::string name;
  std::string bound;
  std::string moved;
  double change = 0.0;  // of the objective
  std::size_t count = 1;
  const BindingBound* first = nullptr;
};

std::vector<Line> lines_of(const case_data::Case& input,
                           const std::vector<BindingBound>& binding) {
  const std::vector<case_data::DesignRow> rows = case_data::design_rows(input);
  std::vector<Line> lines;
  for (const BindingBound& bound : binding) {
    const Bounded of = bounded_by(input, bound);
    const double step = step_of(bound, of.shown);
    const auto vector = vector_with(rows, bound);
    const std::string name = vector ? vector->label() : of.name;
    const auto same =
        std::find_if(lines.begin(), lines.end(), [&](const Line& line) {
          return vector && line.name == name && line.first->of_variable &&
                 line.first->side == bound.side;
        });
    if (same != lines.end()) {
      ++same->count;
      same->change += bound.slope * step;
      continue;
    }
    lines.push_back({.name = name,
                     .bound = bound_text(bound, of.shown),
                     .moved = "to " + of.shown.text(bound.bound + step),
                     .change = bound.slope * step,
                     .first = &bound});
  }
  for (Line& line : lines) {
    if (line.count > 1) {
      line.bound = fmt::format("{} at {} bounds", line.count,
                               optimize::name_of(line.first->side));
      line.moved = "each by 1 %";
    }
  }
  return lines;
}

}  // namespace

nlohmann::ordered_json multipliers_json(const case_data::Case& input,
                                        const optimize::Multipliers& found) {
  Json json = {{"residual", found.residual},
               {"stationarity", found.stationarity},
               {"complementarity", found.complementarity},
               {"binding", Json::array()}};
  for (const BindingBound& bound : found.binding) {
    const Bounded of = bounded_by(input, bound);
    const double step = step_of(bound, of.shown);
    json["binding"].push_back(
        {{"name", of.name},
         {"of", bound.of_variable ? "variable" : "constraint"},
         {"side", optimize::name_of(bound.side)},
         {"bound", bound.bound},
         {"slope", bound.slope},
         {"step", step},
         {"change", bound.slope * step}});
  }
  return json;
}

std::string multipliers_text(const case_data::Case& input,
                             const optimize::Multipliers& found,
                             double objective) {
  std::string text =
      fmt::format("  {} (first-order residual {:.1e})\n",
                  found.binding.empty() ? "no bound binds"
                                        : "what binds, and what it is worth",
                  found.residual);
  const std::string& name = input.responses[*input.study.objective].name;
  const ShownUnit shown = case_data::shown_unit(input, *input.study.objective);
  const std::vector<Line> lines = lines_of(input, found.binding);
  for (std::size_t k = 0; k < std::min(lines.size(), kMostLines); ++k) {
    const Line& line = lines[k];
    text += fmt::format(
        "    {:<18} {:<22} {:<17} {} {}{}", line.name, line.bound, line.moved,
        name, line.change > 0.0 ? "+" : "", shown.text(line.change, 3));
    text += objective == 0.0
                ? "\n"
                : fmt::format(" ({:+.2g} %)\n",
                              100.0 * line.change / std::abs(objective));
  }
  if (lines.size() > kMostLines) {
    text += fmt::format("    and {} more of less weight\n",
                        lines.size() - kMostLines);
  }
  return text;
}

}  // namespace meniscus::study
