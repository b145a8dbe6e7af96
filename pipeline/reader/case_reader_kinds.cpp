/// Which method and which keys belong to which kind of study.
#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "optimize/minimize.h"
#include "pipeline/case_data/study_kinds.h"
#include "pipeline/reader/case_reader_study.h"

namespace meniscus::reader {

namespace {

/// "slsqp (when left out), mma"; NLopt's in the order of their own table.
std::string names_text(const case_data::StudyRow& row,
                       std::vector<std::string> names) {
  const std::vector<optimize::MinimizeMethod>& all =
      optimize::minimize_methods();
  const auto order = [&](const std::string& name) {
    const optimize::MinimizeMethod* method =
        optimize::find_minimize_method(name);
    return method == nullptr ? -1 : static_cast<int>(method - all.data());
  };
  std::stable_sort(
      names.begin(), names.end(),
      [&](const auto& a, const auto& b) { return order(a) < order(b); });
  for (std::string& name : names) {
    name += name == row.usual_method ? " (when left out)" : "";
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string minima_text(const case_data::StudyRow& row) {
  std::vector<std::string> sloped;
  std::vector<std::string> local;
  std::vector<std::string> global;
  for (const optimize::MinimizeMethod& method : optimize::minimize_methods()) {
    (method.gradients ? sloped
     : method.global  ? global
                      : local)
        .push_back(method.name);
  }
  return fmt::format("{} with exact gradients, {} without, {} globally",
                     names_text(row, sloped), names_text(row, local),
                     names_text(row, global));
}

/// "of match: ceres, ...; of minimize and pareto: ...".
std::string all_methods_text() {
  std::string text;
  std::vector<const case_data::StudyRow*> rows;
  for (const case_data::StudyRow& row : case_data::study_kinds()) {
    if (row.kind != case_data::StudyKind::Analyse) {
      rows.push_back(&row);
    }
  }
  while (!rows.empty()) {
    const case_data::StudyRow& first = *rows.front();
    std::vector<std::string> alike;
    std::erase_if(rows, [&](const case_data::StudyRow* row) {
      const bool same = row->methods == first.methods;
      if (same) {
        alike.emplace_back(row->name);
      }
      return same;
    });
    text += fmt::format("{}of {}: {}", text.empty() ? "" : "; ",
                        fmt::join(alike, " and "),
                        first.kind == case_data::StudyKind::Minimize
                            ? minima_text(first)
                            : names_text(first, first.methods));
  }
  return text;
}

void check_method(CaseContext& context, const CaseTable& table,
                  const case_data::StudyEntry& study) {
  const std::vector<std::string>& methods =
      case_data::row_of(study.kind).methods;
  if (std::find(methods.begin(), methods.end(), study.method) ==
      methods.end()) {
    context.problems.unknown(table.line("method"), "method", study.method,
                             methods);
  }
}

/// Names of the kinds of study that each key of [study] belongs to.
std::map<std::string, std::vector<std::string>> owners_of_keys() {
  std::map<std::string, std::vector<std::string>> owners;
  for (const case_data::StudyRow& row : case_data::study_kinds()) {
    for (const std::string& key : row.keys) {
      owners[key].emplace_back(row.name);
    }
  }
  return owners;
}

/// What the file says of its own kind of study counts for nothing while --set
/// asks for another; an override's line is below 0.
bool is_deferred(const CaseTable& table, const char* key) {
  return table.line("kind") < 0 && table.line(key) > 0;
}

}  // namespace

TableSpec study_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "study",
      false,
      TableNeed::Optional,
      "What to do; analyse the initial design when left out",
      {{"kind", K::Choice, D::None, true,
        fmt::format("{}; family: one of these for each member",
                    either_of(split_choices(
                        case_data::choices_of(case_data::study_kinds())))),
        case_data::choices_of(case_data::study_kinds()) + "|family"},
       {"each", K::Choice, D::None, false,
        "of family: what each member's own study is, with the keys of that "
        "kind; minimize when left out",
        "minimize|match|analyse"},
       {"members", K::Members, D::None, false,
        "of family: a table [study.members.NAME] of values by the names of "
        "--set for each, or the path of a csv file, relative to the case"},
       {"equal", K::Names, D::None, false,
        "of match: responses to make equal; mismatch |a-b| / ((|a|+|b|)/2)"},
       {"targets", K::ConstantMap, std::nullopt, false,
        "of match: response = value; mismatch |a-v| / |v|, for v = 0 relative "
        "to the initial response"},
       {"fit", K::Name, D::None, false,
        "of match, instead of equal and targets: a response of kind "
        "scan_distance and measure rms; the films are brought as near to its "
        "scan as the design variables can, in the sense of least squares"},
       {"objective", K::Name, D::None, false,
        "of minimize: the response to make small; of sweep: the one that "
        "makes a design the best, the initial one when left out"},
       {"objectives", K::Names, D::None, false,
        "of pareto: the two responses to make small"},
       {"constraints", K::Constraints, D::None, false,
        "of minimize, sweep and pareto: responses to keep within bounds"},
       {"levels", K::IntegerMap, D::None, false,
        "of sweep by grid: design variable = number of values, ends of its "
        "bounds included; one that is left out stays at its initial value"},
       {"deviations", K::ConstantMap, std::nullopt, false,
        "of tolerance: design variable or parameter = standard deviation"},
       {"count", K::Integer, D::None, false,
        "of sweep by latin_hypercube or sobol: number of designs; of "
        "tolerance: samples that confirm it, none when left out; of pareto: "
        "points of the front, 7 when left out"},
       {"seed", K::Integer, D::None, false,
        "of latin_hypercube: another seed is another sample; 1 when left "
        "out"},
       {"tolerance", K::Constant, D::None, false,
        "of match: largest mismatch accepted, 1e-3 when left out, with fit "
        "the distance that is near enough, as near as it gets when left out; "
        "of minimize and pareto: first-order residual accepted, about the "
        "relative gain "
        "that is left, 1e-4 when left out"},
       {"method", K::Text, D::None, false, all_methods_text()},
       {"coarse_first", K::Constant, D::None, false,
        "of match and minimize: the study is done first on a model with edges "
        "so many times as long (above 1, 2 is usual), and its answer is where "
        "the case's own model starts; no such stage when left out"},
       {"max_evaluations", K::Integer, D::None, false,
        "of match, minimize and each minimum of pareto: limit, "
        "finite-difference ones included; 400 when left out"},
       {"time_limit", K::Constant, D::Time, false,
        "of the whole study, in seconds or as \"10 min\": it stops then and "
        "keeps the best design; --time-limit counts too, the smaller of the "
        "two; no limit when left out"},
       {"refreeze", K::Flag, D::None, false,
        "of match and minimize: where the frozen mesh no longer follows, "
        "freeze a new model at the best design and go on from there, ten "
        "times at most; with resolution.pop, of sweeps too, also at designs "
        "where films join in another way; true when left out"}}};
}

void read_method(CaseContext& context, const CaseTable& table,
                 case_data::StudyEntry& study) {
  const case_data::StudyRow& row = case_data::row_of(study.kind);
  const std::vector<std::string>& own = row.methods;
  study.method = table.text("method").value_or(row.usual_method);
  if (is_deferred(table, "method") &&
      study.kind != case_data::StudyKind::Analyse &&
      std::find(own.begin(), own.end(), study.method) == own.end()) {
    study.method = row.usual_method;
  }
  check_method(context, table, study);
}

void check_keys(CaseContext& context, const CaseTable& table,
                const std::string& kind) {
  static const std::map<std::string, std::vector<std::string>> owners =
      owners_of_keys();
  std::vector<std::string> deferred;
  for (const auto& [key, owning] : owners) {
    if (!table.has(key.c_str()) || kind == "analyse" ||
        std::find(owning.begin(), owning.end(), kind) != owning.end()) {
      continue;
    }
    if (is_deferred(table, key.c_str())) {
      deferred.push_back(key);
      continue;
    }
    context.problems.add(
        table.line(key.c_str()),
        fmt::format("study.{} belongs to kind = \"{}\", and this study's "
                    "kind is \"{}\"; take it out or change the kind",
                    key, fmt::join(owning, "\" or \""), kind));
  }
  if (!deferred.empty()) {
    context.problems.warn(
        table.line("kind"),
        fmt::format("the file's study.{} belong{} to another kind and wait{}",
                    fmt::join(deferred, ", study."),
                    deferred.size() == 1 ? "s" : "",
                    deferred.size() == 1 ? "s" : ""));
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

}  // namespace meniscus::reader
