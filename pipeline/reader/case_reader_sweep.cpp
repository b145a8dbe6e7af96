#include <cstdint>

#include <fmt/format.h>

#include "optimize/samples/sampling.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/reader/case_reader_study.h"

namespace meniscus::reader {

namespace {

constexpr int kMostDesigns = 1'000'000;

/// Levels per design variable, 0 where `levels` does not name it.
void read_levels(CaseContext& context, const CaseTable& table,
                 case_data::Case& result) {
  const toml::node* node = table.node("levels");
  const toml::table* levels = node == nullptr ? nullptr : node->as_table();
  if (levels == nullptr || levels->empty()) {
    context.problems.add(
        table.line("levels"),
        fmt::format("study.levels is {}; a grid needs {{ variable = levels }} "
                    "with a whole number above 0 for each variable that it "
                    "moves",
                    node == nullptr ? "missing" : described(*node)));
    return;
  }
  result.study.levels.assign(result.design.size(), 0);
  double designs = 1.0;
  for (const auto& [key, value] : *levels) {
    const std::string name(key.str());
    const std::vector<std::size_t> moved =
        case_data::positions_of(result, name);
    const auto number = value.value_exact<std::int64_t>();
    if (moved.empty()) {
      context.problems.unknown(context.line_of(value), "design variable", name,
                               case_data::row_names(result));
    } else if (!number || *number < 1 || *number > kMostDesigns) {
      context.problems.add(
          context.line_of(value),
          fmt::format("study.levels.{} is {}; expected a whole number from 1 "
                      "to {}",
                      name, described(value), kMostDesigns));
    } else {
      for (const std::size_t k : moved) {
        result.study.levels[k] = static_cast<int>(*number);
        designs *= static_cast<double>(*number);
      }
    }
  }
  if (designs > kMostDesigns) {
    context.problems.add(
        table.line("levels"),
        fmt::format("study.levels make a grid of {:.0f} designs, more than "
                    "{}; take fewer levels, or method = \"sobol\"",
                    designs, kMostDesigns));
  }
}

void refuse(CaseContext& context, const CaseTable& table, const char* key,
            const char* why) {
  if (table.has(key)) {
    context.problems.add(table.line(key),
                         fmt::format("study.{}: {}; take it out", key, why));
  }
}

}  // namespace

void read_sweep(CaseContext& context, const CaseTable& table,
                case_data::Case& result) {
  case_data::StudyEntry& study = result.study;
  if (study.method == "grid") {
    refuse(context, table, "count", "a grid's levels say how many");
    refuse(context, table, "seed", "a grid has nothing random");
    read_levels(context, table, result);
    return;
  }
  refuse(context, table, "levels", "they belong to method = \"grid\"");
  if (study.method == "sobol") {
    refuse(context, table, "seed", "a Sobol sequence has nothing random");
    if (static_cast<int>(result.design.size()) >
        samples::kMostSobolDimensions) {
      context.problems.add(
          table.line("method"),
          fmt::format("method sobol serves {} design variables at most, the "
                      "case has {}; try latin_hypercube",
                      samples::kMostSobolDimensions, result.design.size()));
    }
  }
  if (!table.has("count")) {
    context.problems.add(
        table.line(),
        fmt::format("a sweep by {} needs study.count, the number of designs",
                    study.method));
  }
  study.count = table.integer_within("count", 1, kMostDesigns).value_or(1);
  study.seed = table.positive_integer("seed").value_or(study.seed);
}

}  // namespace meniscus::reader
