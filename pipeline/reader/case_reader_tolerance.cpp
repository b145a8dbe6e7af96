#include <algorithm>

#include <fmt/format.h>

#include "optimize/samples/sampling.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/reader/case_reader_study.h"

namespace meniscus::reader {

namespace {

constexpr int kMostDesignsLooked = 100'000;
constexpr int kUsualPoints = 7;  // of a front
constexpr int kMostFrontPoints = 1000;

void read_deviation(CaseContext& context, const std::string& name,
                    const toml::node& node, case_data::Case& result) {
  const std::vector<std::size_t> moved = case_data::positions_of(result, name);
  if (moved.empty()) {
    std::vector<std::string> names = case_data::row_names(result);
    for (const case_data::Parameter& parameter : result.parameters) {
      names.push_back(parameter.name);
    }
    context.problems.unknown(context.line_of(node),
                             "design variable or parameter", name, names);
    return;
  }
  const std::string key = "study.deviations." + name;
  const Measure measure = result.design[moved.front()].measure;
  const auto given = read_measured(context, node, std::nullopt, key);
  if (given && given->measure.is_known() && !measure.is_known()) {
    context.problems.add(
        context.line_of(node),
        fmt::format("{} is {}, and '{}' is a plain number; give both a unit or "
                    "none",
                    key, described(node), name));
    return;
  }
  const auto value = read_like(context, node, measure, key);
  if (value && !(*value > 0.0)) {
    context.problems.add(context.line_of(node),
                         fmt::format("study.deviations.{} is {:g}; a standard "
                                     "deviation must be above 0",
                                     name, *value));
    return;
  }
  for (const std::size_t k : moved) {
    result.study.deviations[k] = value.value_or(0.0);
  }
}

}  // namespace

void read_tolerance(CaseContext& context, const CaseTable& table,
                    case_data::Case& result) {
  const toml::node* node = table.node("deviations");
  const toml::table* deviations = node == nullptr ? nullptr : node->as_table();
  if (deviations == nullptr || deviations->empty()) {
    context.problems.add(
        table.line("deviations"),
        fmt::format("study.deviations is {}; a tolerance study needs {{ "
                    "variable = standard deviation }} (of parameters too)",
                    node == nullptr ? "missing" : described(*node)));
    return;
  }
  result.study.deviations.assign(result.design.size(), 0.0);
  for (const auto& [key, value] : *deviations) {
    read_deviation(context, std::string(key.str()), value, result);
  }
  const std::vector<double>& all = result.study.deviations;
  const auto scatter =
      std::count_if(all.begin(), all.end(), [](double d) { return d > 0.0; });
  if (result.study.method == "sobol" &&
      scatter > samples::kMostSobolDimensions) {
    context.problems.add(
        table.line("deviations"),
        fmt::format("method sobol serves {} variables that scatter at most, "
                    "found {}; try latin_hypercube",
                    samples::kMostSobolDimensions, scatter));
  }
  if (result.study.method == "sobol" && table.has("seed")) {
    context.problems.add(table.line("seed"),
                         "study.seed: a Sobol sequence has nothing random; "
                         "take it out");
  }
  if (table.has("count")) {
    result.study.count =
        table.integer_within("count", 2, kMostDesignsLooked).value_or(2);
  }
  result.study.seed =
      table.positive_integer("seed").value_or(result.study.seed);
}

void read_front(CaseContext& context, const CaseTable& table,
                case_data::Case& result) {
  const std::vector<std::string> names = table.names("objectives");
  const case_data::SourceLine line = table.line("objectives");
  if (names.size() != 2 || names[0] == names[1]) {
    context.problems.add(
        line,
        fmt::format("a pareto study needs study.objectives = "
                    "[\"a\", \"b\"], two different "
                    "responses; found {}",
                    names.empty() ? "none"
                                  : fmt::format("{}", fmt::join(names, ", "))));
    return;
  }
  result.study.objective = find_response(context, result, names[0], line);
  result.study.second = find_response(context, result, names[1], line);
  result.study.count =
      table.integer_within("count", 3, kMostFrontPoints).value_or(kUsualPoints);
}

}  // namespace meniscus::reader
