#include "pipeline/case_reader_study.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "optimize/minimize.h"
#include "pipeline/responses.h"
#include "pipeline/studied_responses.h"

namespace meniscus {

namespace {

constexpr double kCoarsest = 8.0;  // edges of a coarser model over the case's

/// The dimension of a response; notes an unknown name.
std::optional<Dimension> response_dimension(CaseContext& context,
                                            const Case& result,
                                            const std::string& name,
                                            SourceLine line) {
  for (const ResponseEntry& response : result.responses) {
    if (response.name == name) {
      return dimension_of(response.kind);
    }
  }
  context.problems.unknown(line, "response", name, response_names(result));
  return std::nullopt;
}

void read_equal(CaseContext& context, const CaseTable& table, Case& result) {
  StudyEntry& study = result.study;
  study.equal = table.names("equal");
  const SourceLine line = table.line("equal");
  std::set<std::string> seen;
  std::set<Dimension> dimensions;
  for (const std::string& name : study.equal) {
    if (const auto dimension =
            response_dimension(context, result, name, line)) {
      dimensions.insert(*dimension);
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

void read_targets(CaseContext& context, const CaseTable& table, Case& result) {
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
    if (const auto dimension =
            response_dimension(context, result, name, context.line_of(value))) {
      result.study.targets.emplace_back(
          name,
          read_constant(context, value, dimension, "study.targets." + name)
              .value_or(0.0));
    }
  }
}

StudyKind kind_of(const std::string& name) {
  static const std::map<std::string, StudyKind> kinds = {
      {"match", StudyKind::Match},
      {"minimize", StudyKind::Minimize},
      {"sweep", StudyKind::Sweep},
      {"tolerance", StudyKind::Tolerance},
      {"pareto", StudyKind::Pareto}};
  const auto at = kinds.find(name);
  return at == kinds.end() ? StudyKind::Analyse : at->second;
}

std::vector<std::string> methods_of(StudyKind kind) {
  if (kind == StudyKind::Sweep) {
    return sweep_methods();
  }
  if (kind == StudyKind::Tolerance) {
    return {"latin_hypercube", "sobol"};
  }
  if (kind == StudyKind::Match) {
    return match_methods();
  }
  std::vector<std::string> names;
  for (const MinimizeMethod& method : minimize_methods()) {
    names.push_back(method.name);
  }
  return names;
}

const char* usual_method(StudyKind kind) {
  switch (kind) {
    case StudyKind::Minimize:
    case StudyKind::Pareto:
      return "slsqp";
    case StudyKind::Sweep:
      return "sobol";
    case StudyKind::Tolerance:
      return "latin_hypercube";
    case StudyKind::Analyse:
    case StudyKind::Match:
      break;
  }
  return "ceres";
}

void check_method(CaseContext& context, const CaseTable& table,
                  const StudyEntry& study) {
  std::vector<std::string> methods;
  if (study.kind == StudyKind::Analyse) {  // the method waits, of any kind
    for (const StudyKind kind :
         {StudyKind::Match, StudyKind::Minimize, StudyKind::Sweep}) {
      for (const std::string& name : methods_of(kind)) {
        methods.push_back(name);
      }
    }
  } else {
    methods = methods_of(study.kind);
  }
  if (std::find(methods.begin(), methods.end(), study.method) ==
      methods.end()) {
    context.problems.unknown(table.line("method"), "method", study.method,
                             methods);
  }
}

/// A study that moves something needs something to move.
void check_variables(CaseContext& context, const CaseTable& table,
                     const std::string& kind, const Case& result) {
  if (result.design.empty()) {
    context.problems.add(
        table.line(),
        fmt::format("study.kind {} needs a design variable to move: add "
                    "[design.NAME] with initial and bounds",
                    kind));
  }
}

/// Keys that belong to another kind of study; to analyse is to leave a study's
/// work for later, and its keys wait.
void check_keys(CaseContext& context, const CaseTable& table,
                const std::string& kind) {
  static const std::map<std::string, std::vector<std::string>> owners = {
      {"equal", {"match"}},
      {"targets", {"match"}},
      {"tolerance", {"match", "minimize", "pareto"}},
      {"max_evaluations", {"match", "minimize", "pareto"}},
      {"coarse_first", {"match", "minimize"}},
      {"objective", {"minimize", "sweep"}},
      {"objectives", {"pareto"}},
      {"constraints", {"minimize", "sweep", "pareto"}},
      {"levels", {"sweep"}},
      {"deviations", {"tolerance"}},
      {"count", {"sweep", "tolerance", "pareto"}},
      {"seed", {"sweep", "tolerance"}}};
  for (const auto& [key, owning] : owners) {
    if (table.has(key.c_str()) && kind != "analyse" &&
        std::find(owning.begin(), owning.end(), kind) == owning.end()) {
      context.problems.add(
          table.line(key.c_str()),
          fmt::format("study.{} belongs to kind = \"{}\", and this study's "
                      "kind is \"{}\"; take it out or change the kind",
                      key, fmt::join(owning, "\" or \""), kind));
    }
  }
  if (kind == "match" && !table.has("equal") && !table.has("targets")) {
    context.problems.add(table.line(),
                         "a match needs study.equal = [\"a\", \"b\"] or "
                         "study.targets = { a = value }");
  }
  if (kind == "minimize" && !table.has("objective")) {
    context.problems.add(table.line(),
                         "a minimize study needs study.objective = "
                         "\"response\"");
  }
}

}  // namespace

std::optional<int> find_response(CaseContext& context, const Case& result,
                                 const std::string& name, SourceLine line) {
  if (!response_dimension(context, result, name, line)) {
    return std::nullopt;
  }
  return response_index(result, name);
}

namespace {

/// Index of the response that `key` names; 0 for none, which is noted.
int index_of_response(CaseContext& context, const CaseTable& table,
                      const char* key, const Case& result) {
  const auto name = table.text(key);
  if (!name || !response_dimension(context, result, *name, table.line(key))) {
    return 0;
  }
  return response_index(result, *name);
}

std::optional<double> bound_of(CaseContext& context, const CaseTable& table,
                               const char* key, const Case& result,
                               int response) {
  const toml::node* node = table.node(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  const ResponseKind kind = result.responses[response].kind;
  return read_constant(context, *node,
                       kind == ResponseKind::Expression
                           ? std::nullopt
                           : std::optional<Dimension>(dimension_of(kind)),
                       table.path() + "." + key);
}

void read_constraints(CaseContext& context, const CaseTable& table,
                      Case& result) {
  for (const CaseTable& entry : table.tables("constraints", "constraint")) {
    if (!entry.has("response") || result.responses.empty()) {
      continue;
    }
    ConstraintEntry constraint{
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
                       const Case& result) {
  if (!asks_for_gradients(result.study)) {
    return;
  }
  for (const int response : studied_responses(result)) {
    if (!has_derivatives(result, response)) {
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
                    Case& result) {
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
                       StudyEntry& study) {
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

}  // namespace

void read_study(CaseContext& context, const toml::table& root, Case& result) {
  const auto table = single_table(context, root, "study");
  if (!table) {
    return;
  }
  StudyEntry& study = result.study;
  study.line = table->line();
  const std::string asked = table->choice("kind").value_or("analyse");
  const std::string kind =
      asked == "family" ? read_members(context, *table, result) : asked;
  study.kind = kind_of(kind);
  const bool minimizes =
      study.kind == StudyKind::Minimize || study.kind == StudyKind::Pareto;
  const bool sweeps = study.kind == StudyKind::Sweep;
  study.tolerance =
      table->constant("tolerance").value_or(minimizes ? 1e-4 : 1e-3);
  if (!(study.tolerance > 0.0)) {
    context.problems.add(table->line("tolerance"),
                         fmt::format("study.tolerance is {:g}; it must be "
                                     "above 0",
                                     study.tolerance));
  }
  study.method = table->text("method").value_or(usual_method(study.kind));
  check_method(context, *table, study);
  study.max_evaluations = table->positive_integer("max_evaluations")
                              .value_or(study.max_evaluations);
  read_coarse_first(context, *table, study);
  check_keys(context, *table, kind);
  if (study.kind != StudyKind::Analyse) {
    check_variables(context, *table, kind, result);
  }
  read_equal(context, *table, result);
  read_targets(context, *table, result);
  if (sweeps) {
    read_sweep(context, *table, result);
  }
  if (study.kind == StudyKind::Tolerance) {
    read_tolerance(context, *table, result);
  }
  if (study.kind == StudyKind::Pareto) {
    read_front(context, *table, result);
  }
  if (minimizes || sweeps) {
    read_objective(context, *table, result);
  }
}

}  // namespace meniscus
