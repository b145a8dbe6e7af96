#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "optimize/problem.h"
#include "pipeline/case_checks.h"
#include "pipeline/case_reader_tables.h"

namespace meniscus {

namespace {

/// The load case that `key` names; the first when left out or wrong.
int index_of_load_case(CaseContext& context, const CaseTable& table,
                       const Case& result, const char* key = "load_case") {
  const auto wanted = table.text(key);
  if (!wanted) {
    return 0;
  }
  std::vector<std::string> known;
  for (const LoadCaseEntry& entry : result.load_cases) {
    if (entry.name == *wanted) {
      return static_cast<int>(known.size());
    }
    known.push_back(entry.name);
  }
  context.problems.unknown(table.line(key), "load case", *wanted, known);
  return 0;
}

/// `key` stands there just when the kind needs it.
void check_belongs(CaseContext& context, const CaseTable& table,
                   const std::string& kind, const char* key, bool needed) {
  if (needed && !table.has(key)) {
    context.problems.add(table.line(),
                         fmt::format("{} is a {} and has no '{}'; add it",
                                     table.path(), kind, key));
  } else if (!needed && table.has(key)) {
    context.problems.add(table.line(key),
                         fmt::format("{}.{} does not belong to a {}; take it "
                                     "out",
                                     table.path(), key, kind));
  }
}

void read_responses(CaseContext& context, const toml::table& root,
                    Case& result) {
  static const std::map<std::string, ResponseKind> kinds = {
      {"mean_displacement", ResponseKind::MeanDisplacement},
      {"mass", ResponseKind::Mass},
      {"volume", ResponseKind::Volume},
      {"max_von_mises", ResponseKind::MaxVonMises},
      {"strain_energy", ResponseKind::StrainEnergy},
      {"film_area", ResponseKind::FilmArea}};
  for (const CaseTable& table : named_tables(context, root, "responses")) {
    ResponseEntry response{.name = table.name(), .line = table.line()};
    if (const auto kind = table.choice("kind")) {
      response.kind = kinds.at(*kind);
      const bool mean = response.kind == ResponseKind::MeanDisplacement;
      check_belongs(context, table, *kind, "on", mean);
      check_belongs(context, table, *kind, "direction", mean);
    }
    response.surface = surface_on(context, table, result);
    response.direction = table.vector_or_zero("direction");
    response.load_case = index_of_load_case(context, table, result);
    result.responses.push_back(std::move(response));
  }
}

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

void check_method(CaseContext& context, const CaseTable& table,
                  const StudyEntry& study) {
  const std::vector<std::string> methods = match_methods();
  if (std::find(methods.begin(), methods.end(), study.method) ==
      methods.end()) {
    context.problems.unknown(table.line("method"), "method", study.method,
                             methods);
  }
}

void check_match(CaseContext& context, const CaseTable& table,
                 const Case& result) {
  if (!table.has("equal") && !table.has("targets")) {
    context.problems.add(table.line(),
                         "a match needs study.equal = [\"a\", \"b\"] or "
                         "study.targets = { a = value }");
  }
  if (result.design.empty()) {
    context.problems.add(table.line(),
                         "a match needs a design variable to move: add "
                         "[design.NAME] with initial and bounds");
  }
}

/// More modes at once would take more memory than the part's own solve.
constexpr int kMostModes = 50;

/// After the eigenvalues that are asked for.
void read_solver(CaseContext& context, const CaseTable& table,
                 AnalysisEntry& analysis) {
  static const std::map<std::string, SolverKind> kinds = {
      {"auto", SolverKind::Automatic},
      {"cholmod", SolverKind::Cholesky},
      {"p-multigrid", SolverKind::Multigrid},
      {"petsc", SolverKind::Distributed}};
  if (const auto kind = table.choice("solver")) {
    analysis.solver = kinds.at(*kind);
  }
  if (analysis.solver != SolverKind::Distributed) {
    if (table.has("processes")) {
      context.problems.add(table.line("processes"),
                           "analysis.processes belongs to solver = \"petsc\"; "
                           "take it out, or choose that solver");
    }
    return;
  }
  analysis.processes = table.integer_within("processes", 1, kMostProcesses)
                           .value_or(analysis.processes);
  for (const auto& [key, asked] :
       {std::pair("frequencies", analysis.frequencies > 0),
        std::pair("buckling", analysis.buckling.value_or(0) > 0)}) {
    if (asked) {
      context.problems.add(
          table.line(key),
          fmt::format("analysis.{} needs the matrix in one process, and solver "
                      "= \"petsc\" spreads it; choose another solver or take "
                      "it out",
                      key));
    }
  }
}

void read_analysis_table(CaseContext& context, const toml::table& root,
                         Case& result) {
  const auto table = single_table(context, root, "analysis");
  if (!table) {
    return;
  }
  AnalysisEntry& analysis = result.analysis;
  analysis.adapt = table->flag("adapt").value_or(false);
  read_zones(context, *table, result);
  analysis.frequencies =
      table->integer_within("frequencies", 0, kMostModes).value_or(0);
  analysis.buckling = table->integer_within("buckling", 0, kMostModes);
  read_solver(context, *table, analysis);
  const auto is_free = [](const LoadCaseEntry& entry) {
    return entry.name == "free";
  };
  if (table->text("supports_of") == "free" &&
      std::none_of(result.load_cases.begin(), result.load_cases.end(),
                   is_free)) {
    analysis.supports_of = AnalysisEntry::kFree;
  } else {
    analysis.supports_of =
        index_of_load_case(context, *table, result, "supports_of");
  }
  if (result.load_cases.empty() && context.problems.empty()) {
    context.problems.add(table->line(),
                         "analysis needs a load case: its supports and loads");
  }
}

void read_study(CaseContext& context, const toml::table& root, Case& result) {
  const auto table = single_table(context, root, "study");
  if (!table) {
    return;
  }
  StudyEntry& study = result.study;
  study.line = table->line();
  const auto kind = table->choice("kind");
  study.kind = kind == "match" ? StudyKind::Match : StudyKind::Analyse;
  read_equal(context, *table, result);
  read_targets(context, *table, result);
  study.tolerance = table->constant("tolerance").value_or(study.tolerance);
  if (!(study.tolerance > 0.0)) {
    context.problems.add(table->line("tolerance"),
                         fmt::format("study.tolerance is {:g}; it must be "
                                     "above 0",
                                     study.tolerance));
  }
  study.method = table->text("method").value_or(study.method);
  check_method(context, *table, study);
  study.max_evaluations = table->positive_integer("max_evaluations")
                              .value_or(study.max_evaluations);
  if (study.kind == StudyKind::Match) {
    check_match(context, *table, result);
  }
}

}  // namespace

void read_analysis(CaseContext& context, const toml::table& root,
                   Case& result) {
  read_load_cases(context, root, result);
  read_analysis_table(context, root, result);
  read_responses(context, root, result);
  read_study(context, root, result);
}

}  // namespace meniscus
