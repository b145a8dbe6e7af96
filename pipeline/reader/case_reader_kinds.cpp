/// Which method and which keys belong to which kind of study.
#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "optimize/minimize.h"
#include "optimize/problem.h"
#include "pipeline/reader/case_reader_study.h"

namespace meniscus {

namespace {

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

/// What the file says of its own kind of study counts for nothing while --set
/// asks for another; an override's line is below 0.
bool waits(const CaseTable& table, const char* key) {
  return table.line("kind") < 0 && table.line(key) > 0;
}

}  // namespace

void read_method(CaseContext& context, const CaseTable& table,
                 StudyEntry& study) {
  study.method = table.text("method").value_or(usual_method(study.kind));
  const std::vector<std::string> own = methods_of(study.kind);
  if (waits(table, "method") && study.kind != StudyKind::Analyse &&
      std::find(own.begin(), own.end(), study.method) == own.end()) {
    study.method = usual_method(study.kind);
  }
  check_method(context, table, study);
}

void check_keys(CaseContext& context, const CaseTable& table,
                const std::string& kind) {
  static const std::map<std::string, std::vector<std::string>> owners = {
      {"equal", {"match"}},
      {"targets", {"match"}},
      {"fit", {"match"}},
      {"tolerance", {"match", "minimize", "pareto"}},
      {"max_evaluations", {"match", "minimize", "pareto"}},
      {"coarse_first", {"match", "minimize"}},
      {"refreeze", {"match", "minimize"}},
      {"objective", {"minimize", "sweep"}},
      {"objectives", {"pareto"}},
      {"constraints", {"minimize", "sweep", "pareto"}},
      {"levels", {"sweep"}},
      {"deviations", {"tolerance"}},
      {"count", {"sweep", "tolerance", "pareto"}},
      {"seed", {"sweep", "tolerance"}}};
  std::vector<std::string> waiting;
  for (const auto& [key, owning] : owners) {
    if (!table.has(key.c_str()) || kind == "analyse" ||
        std::find(owning.begin(), owning.end(), kind) != owning.end()) {
      continue;
    }
    if (waits(table, key.c_str())) {
      waiting.push_back(key);
      continue;
    }
    context.problems.add(
        table.line(key.c_str()),
        fmt::format("study.{} belongs to kind = \"{}\", and this study's "
                    "kind is \"{}\"; take it out or change the kind",
                    key, fmt::join(owning, "\" or \""), kind));
  }
  if (!waiting.empty()) {
    context.problems.warn(
        table.line("kind"),
        fmt::format("the file's study.{} belong{} to another kind and wait{}",
                    fmt::join(waiting, ", study."),
                    waiting.size() == 1 ? "s" : "",
                    waiting.size() == 1 ? "s" : ""));
  }
  const bool of_values = table.has("equal") || table.has("targets");
  if (kind == "match" && of_values == table.has("fit")) {
    context.problems.add(
        table.line(),
        of_values ? "study.fit matches a scan, study.equal and study.targets "
                    "match values; take one out"
                  : "a match needs study.equal = [\"a\", \"b\"], "
                    "study.targets = { a = value } or study.fit = \"a\"");
  }
  if (kind == "minimize" && !table.has("objective")) {
    context.problems.add(table.line(),
                         "a minimize study needs study.objective = "
                         "\"response\"");
  }
}

}  // namespace meniscus
