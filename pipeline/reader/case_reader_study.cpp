#include "pipeline/reader/case_reader_study.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "optimize/minimize.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/case_data/studied_responses.h"
#include "pipeline/case_data/study_kinds.h"

namespace meniscus::reader {

namespace {

constexpr double kCoarsest = 8.0;  // edges of a coarser model over the case's

/// The dimension of a response, and its measure; notes an unknown name.
struct ResponseMeasure {
  Dimension dimension = Dimension::None;
  Measure measure;
};
std::optional<ResponseMeasure> response_measure(CaseContext& context,
                                                const case_data::Case& result,
                                                const std::string& name,
                                                case_data::SourceLine line) {
  for (const case_data::ResponseEntry& response : result.responses) {
    if (response.name == name) {
      return ResponseMeasure{case_data::dimension_of(response.kind),
                             case_data::measure_of(response)};
    }
  }
  context.problems.unknown(line, "response", name,
                           case_data::response_names(result));
  return std::nullopt;
}

void read_equal(CaseContext& context, const CaseTable& table,
                case_data::Case& result) {
  case_data::StudyEntry& study = result.study;
  study.equal = table.names("equal");
  const case_data::SourceLine line = table.line("equal");
  std::set<std::string> seen;
  std::set<Dimension> dimensions;
  for (const std::string& name : study.equal) {
    if (const auto found = response_measure(context, result, name, line)) {
      dimensions.insert(found->dimension);
    }
    if (!seen.insert(name).second) {
      context.problems.add(
          line,
          fmt::format("study.equal names '{}' twice; name each once", name));
    }
  }
  if (dimensions.size() > 1) {
    context.problems.add(line,
                         "study.equal names responses of different dimensions; "
                         "only like can be made equal");
  }
  if (study.equal.size() == 1) {
    context.problems.add(
        line, "study.equal names one response; two or more can be made equal");
  }
}

void read_targets(CaseContext& context, const CaseTable& table,
                  case_data::Case& result) {
  const toml::node* node = table.node("targets");
  if (node == nullptr) {
    return;
  }
  const toml::table* targets = node->as_table();
  if (targets == nullptr || targets->empty()) {
    context.problems.add(
        context.line_of(*node),
        fmt::format("study.targets is {}; expected {{ response = value }}",
                    targets == nullptr ? described(*node) : "empty"));
    return;
  }
  for (const auto& [key, value] : *targets) {
    const std::string name(key.str());
    if (const auto found =
            response_measure(context, result, name, context.line_of(value))) {
      result.study.targets.emplace_back(
          name,
          read_like(context, value, found->measure, "study.targets." + name)
              .value_or(0.0));
    }
  }
}

/// The distance to a scan that a match makes small, and how small is enough.
void read_fit(CaseContext& context, const CaseTable& table,
              case_data::Case& result) {
  const auto name = table.text("fit");
  if (!name) {
    return;
  }
  const case_data::SourceLine line = table.line("fit");
  result.study.fit = find_response(context, result, *name, line);
  if (!result.study.fit) {
    return;
  }
  const case_data::ResponseEntry& response =
      result.responses[static_cast<std::size_t>(*result.study.fit)];
  if (response.kind != case_data::ResponseKind::ScanDistance ||
      response.measure != scan::ScanMeasure::Rms) {
    context.problems.add(
        line, fmt::format("study.fit names '{}'; expected a response of kind = "
                          "\"scan_distance\" and measure = \"rms\"",
                          *name));
  }
  if (result.study.method != "ceres") {
    context.problems.add(
        table.line("method"),
        fmt::format("study.fit is a match of many distances by method ceres; "
                    "found \"{}\"",
                    result.study.method));
  }
  if (!table.has("tolerance")) {
    result.study.tolerance = 0.0;
  }
}

/// A study that moves something needs something to move.
void check_variables(CaseContext& context, const CaseTable& table,
                     const std::string& kind, const case_data::Case& result) {
  if (result.design.empty()) {
    context.problems.add(
        table.line(),
        fmt::format("study.kind {} needs a design variable to move: add "
                    "[design.NAME] with initial and bounds",
                    kind));
  }
}

}  // namespace

std::optional<int> find_response(CaseContext& context,
                                 const case_data::Case& result,
                                 const std::string& name,
                                 case_data::SourceLine line) {
  if (!response_measure(context, result, name, line)) {
    return std::nullopt;
  }
  return case_data::response_index(result, name);
}

std::optional<double> read_like(CaseContext& context, const toml::node& node,
                                const Measure& measure,
                                const std::string& key) {
  const auto found = read_measured(context, node, std::nullopt, key);
  if (!found) {
    return std::nullopt;
  }
  if (!measure.is_known() && found->measure.is_known()) {
    context.problems.add(
        context.line_of(node),
        fmt::format("{} is {}, {}, of what adds quantities of several "
                    "dimensions or has none that is known; write a plain "
                    "number, in the units of the case",
                    key, described(node), described(found->measure.powers)));
    return std::nullopt;
  }
  if (measure.is_known() && found->measure.is_known() &&
      !(measure.powers == found->measure.powers)) {
    context.problems.add(
        context.line_of(node),
        fmt::format("{} is {}, {}; expected {}", key, described(node),
                    described(found->measure.powers),
                    described(measure.powers)));
    return std::nullopt;
  }
  return found->value;
}

namespace {

/// Index of the response that `key` names; 0 for none, which is noted.
int index_of_response(CaseContext& context, const CaseTable& table,
                      const char* key, const case_data::Case& result) {
  const auto name = table.text(key);
  if (!name || !response_measure(context, result, *name, table.line(key))) {
    return 0;
  }
  return case_data::response_index(result, *name);
}

std::optional<double> bound_of(CaseContext& context, const CaseTable& table,
                               const char* key, const case_data::Case& result,
                               int response) {
  const toml::node* node = table.node(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  return read_like(context, *node,
                   case_data::measure_of(result.responses[response]),
                   table.path() + "." + key);
}

void read_constraints(CaseContext& context, const CaseTable& table,
                      case_data::Case& result) {
  for (const CaseTable& entry : table.tables("constraints", "constraint")) {
    if (!entry.has("response") || result.responses.empty()) {
      continue;
    }
    case_data::ConstraintEntry constraint{
        .response = index_of_response(context, entry, "response", result),
        .line = entry.line()};
    if (!entry.has("min") && !entry.has("max")) {
      context.problems.add(
          entry.line(),
          fmt::format("{} bounds nothing; add min or max", entry.path()));
    }
    constraint.lower =
        bound_of(context, entry, "min", result, constraint.response)
            .value_or(constraint.lower);
    constraint.upper =
        bound_of(context, entry, "max", result, constraint.response)
            .value_or(constraint.upper);
    if (constraint.lower > constraint.upper) {
      context.problems.add(
          entry.line(),
          fmt::format("{}: min is {:g} and max {:g}; nothing lies between",
                      entry.path(), constraint.lower, constraint.upper));
    }
    result.study.constraints.push_back(constraint);
  }
}

/// What a gradient method asks of responses that have no derivatives.
void check_derivatives(CaseContext& context, const CaseTable& table,
                       const case_data::Case& result) {
  if (!case_data::asks_for_gradients(result.study)) {
    return;
  }
  for (const int response : case_data::studied_responses(result)) {
    if (!case_data::has_derivatives(result, response)) {
      context.problems.add(
          table.line(),
          fmt::format("response '{}' has no derivatives, and method {} needs "
                      "them: use von_mises_norm or von_mises_ks for a peak, "
                      "or method = \"cobyla\"",
                      result.responses[response].name, result.study.method));
    }
  }
}

void read_objective(CaseContext& context, const CaseTable& table,
                    case_data::Case& result) {
  if (result.responses.empty() || !context.problems.empty()) {
    return;
  }
  if (table.has("objective")) {
    result.study.objective =
        index_of_response(context, table, "objective", result);
  } else if (table.has("constraints") && !result.study.objective) {
    context.problems.add(table.line("constraints"),
                         "study.constraints say which designs count, and "
                         "study.objective which is the best of them; add it");
  }
  read_constraints(context, table, result);
  check_derivatives(context, table, result);
}

void read_coarse_first(CaseContext& context, const CaseTable& table,
                       case_data::StudyEntry& study) {
  const std::optional<double> factor = table.constant("coarse_first");
  if (!factor) {
    return;
  }
  if (!(*factor > 1.0 && *factor <= kCoarsest)) {
    context.problems.add(
        table.line("coarse_first"),
        fmt::format("study.coarse_first is {:g}; it must be above 1 and at "
                    "most {:g}, 2 is usual",
                    *factor, kCoarsest));
    return;
  }
  study.coarse_first = *factor;
}

void read_time_limit(CaseContext& context, const CaseTable& table,
                     case_data::StudyEntry& study) {
  const std::optional<double> limit = table.constant("time_limit");
  if (limit && !(*limit > 0.0)) {
    context.problems.add(
        table.line("time_limit"),
        fmt::format("study.time_limit is {:g}; it must be above 0: seconds, or "
                    "a time such as \"10 min\"",
                    *limit));
    return;
  }
  study.time_limit = limit.value_or(0.0);
}

}  // namespace

void read_study(CaseContext& context, const toml::table& root,
                case_data::Case& result) {
  const auto table = single_table(context, root, "study");
  if (!table) {
    return;
  }
  case_data::StudyEntry& study = result.study;
  study.line = table->line();
  const std::string asked = table->choice("kind").value_or("analyse");
  const std::string kind =
      asked == "family" ? read_members(context, *table, result) : asked;
  study.kind = case_data::row_named(case_data::study_kinds(), kind).kind;
  const bool minimizes = study.kind == case_data::StudyKind::Minimize ||
                         study.kind == case_data::StudyKind::Pareto;
  const bool sweeps = study.kind == case_data::StudyKind::Sweep;
  study.tolerance =
      table->constant("tolerance").value_or(minimizes ? 1e-4 : 1e-3);
  if (!(study.tolerance > 0.0)) {
    context.problems.add(table->line("tolerance"),
                         fmt::format("study.tolerance is {:g}; it must be "
                                     "above 0",
                                     study.tolerance));
  }
  read_method(context, *table, study);
  study.max_evaluations = table->positive_integer("max_evaluations")
                              .value_or(study.max_evaluations);
  read_coarse_first(context, *table, study);
  read_time_limit(context, *table, study);
  study.refreeze = table->flag("refreeze").value_or(study.refreeze);
  check_keys(context, *table, kind);
  if (study.kind != case_data::StudyKind::Analyse) {
    check_variables(context, *table, kind, result);
  }
  read_equal(context, *table, result);
  read_targets(context, *table, result);
  read_fit(context, *table, result);
  if (sweeps) {
    read_sweep(context, *table, result);
  }
  if (study.kind == case_data::StudyKind::Tolerance) {
    read_tolerance(context, *table, result);
  }
  if (study.kind == case_data::StudyKind::Pareto) {
    read_front(context, *table, result);
  }
  if (minimizes || sweeps) {
    read_objective(context, *table, result);
  }
}

}  // namespace meniscus::reader
